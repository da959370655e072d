#include <fmt/format.h>

#include <array>
#include <cmath>

#include "check/arm.hpp"
#include "check/readings.hpp"
#include "check/turns.hpp"
#include "controller/kuka_axes.hpp"

namespace flexcomp::check {
namespace {

constexpr Eigen::Index kMostForAllSigns = 8;  // joints

/// Handicap of readings that are about joints, for a tie with the axes of the frame.
constexpr double kLessLikely = 1e-7;  // m

class JointReadings {
 public:
  JointReadings(const model::Robot& robot, const PoseRows& rows) : robot_(robot), rows_(rows) {}

  void try_out(int steps, Check check, std::function<void(Eigen::MatrixXd*)> mend) {
    Eigen::MatrixXd q = rows_.q;
    mend(&q);
    Reading reading;
    reading.steps = steps;
    reading.check = std::move(check);
    reading.left = median_distance(positions_at(robot_, q), rows_.measured) + kLessLikely;
    reading.mend_angles = std::move(mend);
    readings.push_back(std::move(reading));
  }

  Readings readings;

 private:
  const model::Robot& robot_;
  const PoseRows& rows_;
};

Check said(const std::string& name, const std::string& what, const std::string& fix) {
  return {Severity::error, "recording", name, what, fix};
}

void try_units(const model::Robot& robot, JointReadings* readings) {
  const auto scaled = [&robot](double by) {
    return [&robot, by](Eigen::MatrixXd* q) {
      for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
        q->col(joint) *= turns(robot, joint) ? by : 1;
      }
    };
  };
  readings->try_out(1,
                    said("units.angle", "the joint angles look like degrees",
                         "give joint angles in radians: multiply them by π/180"),
                    scaled(kDegree));
  readings->try_out(1,
                    said("units.angle",
                         "the joint angles are about 57 times too small, as if turned into radians "
                         "twice",
                         "give joint angles in radians: multiply them by 180/π"),
                    scaled(1 / kDegree));
}

void try_signs(Eigen::Index joints, JointReadings* readings) {
  for (unsigned mask = 1; mask < 1U << static_cast<unsigned>(joints); ++mask) {
    int count = 0;
    std::string names;
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      if ((mask >> static_cast<unsigned>(joint) & 1U) != 0) {
        names += fmt::format("{}{}", count > 0 ? ", " : "", joint + 1);
        ++count;
      }
    }
    if (joints > kMostForAllSigns && count > 2) {
      continue;
    }
    const std::string whose = fmt::format("joint{} {}", count > 1 ? "s" : "", names);
    readings->try_out(count,
                      said("joint.sign",
                           fmt::format("the angle{} of {} {} the opposite sign of the model's",
                                       count > 1 ? "s" : "", whose, count > 1 ? "have" : "has"),
                           fmt::format("turn the sign of {}, or of the axis in the URDF", whose)),
                      [mask](Eigen::MatrixXd* q) {
                        for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
                          q->col(joint) *=
                              (mask >> static_cast<unsigned>(joint) & 1U) != 0 ? -1 : 1;
                        }
                      });
  }
}

void try_orders(Eigen::Index joints, JointReadings* readings) {
  for (Eigen::Index one = 0; one < joints; ++one) {
    for (Eigen::Index other = one + 1; other < joints; ++other) {
      readings->try_out(
          1,
          said("joint.order",
               fmt::format("the angles of joints {} and {} are swapped", one + 1, other + 1),
               "put the columns into the order of the joints, base to tip"),
          [one, other](Eigen::MatrixXd* q) { q->col(one).swap(q->col(other)); });
    }
  }
  readings->try_out(1,
                    said("joint.order", "the joints' angles stand in reverse order, tip to base",
                         "put the columns into the order of the joints, base to tip"),
                    [](Eigen::MatrixXd* q) { *q = q->rowwise().reverse().eval(); });
}

void try_zeros(const model::Robot& robot, JointReadings* readings) {
  for (Eigen::Index joint = 0; joint < joint_count(robot); ++joint) {
    for (const int quarters : {1, -1, 2}) {
      for (const double sign : {1.0, -1.0}) {
        if (!turns(robot, joint)) {
          continue;
        }
        readings->try_out(
            sign > 0 ? 1 : 2,
            said(
                "joint.zero",
                fmt::format("the zero of joint {} lies {}° from the model's{}", joint + 1,
                            90 * quarters, sign > 0 ? "" : ", and its sign is turned"),
                fmt::format("add {}° to the angle of joint {}{}, or turn the joint's origin in the "
                            "URDF",
                            90 * quarters, joint + 1, sign > 0 ? "" : " after turning its sign")),
            [joint, quarters, sign](Eigen::MatrixXd* q) {
              q->col(joint) =
                  (sign * q->col(joint)).array() + static_cast<double>(quarters) * kQuarterTurn;
            });
      }
    }
  }
}

/// Angles off a KUKA's panel, of a robot whose URDF counts otherwise.
void try_kuka(const model::Robot& robot, JointReadings* readings) {
  const std::optional<RobotModel<double, 6>> model = model::six_axis_model(robot.elastic);
  const std::optional<AxisConvention> axes = model ? controller::kuka_axes(*model) : std::nullopt;
  if (!axes) {
    return;
  }
  readings->try_out(
      1,
      said("joint.zero", "the joint angles are counted as a KUKA counts its axes, not as the URDF",
           fmt::format("give sign · (shown − zero) of each joint: signs {}, zeros {} degrees; "
                       "flexcomp convert --map does, as in q_meas_2=A2:deg*-1-90",
                       controller::list_of(axes->sign), controller::list_of(axes->zero))),
      [axes](Eigen::MatrixXd* q) {
        for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
          const auto at = static_cast<std::size_t>(joint);
          q->col(joint) = axes->sign[at] * (q->col(joint).array() - axes->zero[at] * kDegree);
        }
      });
}

}  // namespace

Readings joint_readings(const model::Robot& robot, const PoseRows& rows) {
  JointReadings readings(robot, rows);
  try_units(robot, &readings);
  try_signs(joint_count(robot), &readings);
  try_orders(joint_count(robot), &readings);
  try_zeros(robot, &readings);
  try_kuka(robot, &readings);
  return readings.readings;
}

}  // namespace flexcomp::check
