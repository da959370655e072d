#include "check/angles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/turns.hpp"

namespace flexcomp::check {
namespace {

using Group = std::optional<recording::Samples> recording::Recording::*;

struct AngleGroup {
  Group group;
  const char* name;
};

constexpr AngleGroup kAngleGroups[] = {{&recording::Recording::q_cmd, "q_cmd"},
                                       {&recording::Recording::q_meas, "q_meas"},
                                       {&recording::Recording::q_link, "q_link"}};

/// Share of the samples, in so many radians each, beyond the joints' limits by more than `margin`.
double share_beyond(const model::Robot& robot, const recording::Samples& q, double unit,
                    double margin) {
  double beyond = 0;
  double count = 0;
  for (Eigen::Index joint = 0; joint < q.cols(); ++joint) {
    if (!turns(robot, joint)) {
      continue;
    }
    const Joint<double>& limits = joint_of(robot, joint);
    for (Eigen::Index row = 0; row < q.rows(); ++row) {
      const double angle = unit * q(row, joint);
      if (std::isfinite(angle)) {
        count += 1;
        beyond += angle < limits.lower - margin || angle > limits.upper + margin ? 1 : 0;
      }
    }
  }
  return count > 0 ? beyond / count : 0;
}

void scale_turning(const model::Robot& robot, double by, recording::Samples* q) {
  for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
    q->col(joint) *= turns(robot, joint) ? by : 1;
  }
}

Checks check_degrees(const model::Robot& robot, const AngleGroup& angles,
                     recording::Recording* recording) {
  std::optional<recording::Samples>& q = recording->*angles.group;
  // A recording's limits may be a little off; half a turn no robot is.
  if (!q || share_beyond(robot, *q, 1, kHalfTurn) < 0.01 ||
      share_beyond(robot, *q, kDegree, 0.2) > 0.01) {
    return {};
  }
  scale_turning(robot, kDegree, &*q);
  return {{Severity::error, "recording", "units.angle",
           fmt::format("{}: {}_1 to {}_{} look like degrees: they lie far outside the joints' "
                       "limits, and within them as degrees",
                       recording->file, angles.name, angles.name, q->cols()),
           "give joint angles in radians: multiply them by π/180"}};
}

/// Angles of a joint that lie outside its limits as they stand, and within with the other sign.
Checks check_group_by_limits(const model::Robot& robot, const AngleGroup& angles,
                             recording::Recording* recording) {
  constexpr double kMargin = 0.1;  // rad
  std::optional<recording::Samples>& q = recording->*angles.group;
  Checks checks;
  for (Eigen::Index joint = 0; q && joint < q->cols(); ++joint) {
    const Joint<double>& limits = joint_of(robot, joint);
    const auto outside = [&](double sign) {
      const Eigen::ArrayXd angle = sign * q->col(joint).array();
      return static_cast<double>(
                 (angle < limits.lower - kMargin || angle > limits.upper + kMargin).count()) /
             static_cast<double>(std::max<Eigen::Index>(angle.size(), 1));
    };
    if (turns(robot, joint) && outside(1) > 0.5 && outside(-1) == 0) {
      checks.push_back(
          {Severity::error, "recording", "joint.sign",
           fmt::format("{}: {}_{} lies outside the joint's limits of {:.4g} to {:.4g} "
                       "rad, but within them with the other sign",
                       recording->file, angles.name, joint + 1, limits.lower, limits.upper),
           "turn the sign of the angle, or of the joint's axis in the URDF"});
      q->col(joint) *= -1;
    }
  }
  return checks;
}

/// Slope of one column of angles over another, both as they move, and how well it fits.
struct Slope {
  double value = 0;
  double correlation = 0;
};

Slope slope(const Eigen::VectorXd& of, const Eigen::VectorXd& over) {
  Eigen::Index count = 0;
  double sums[5] = {};
  for (Eigen::Index row = 0; row < of.size(); ++row) {
    if (std::isfinite(of[row]) && std::isfinite(over[row])) {
      const double values[] = {over[row], of[row], over[row] * over[row], over[row] * of[row],
                               of[row] * of[row]};
      for (int i = 0; i < 5; ++i) {
        sums[i] += values[i];
      }
      ++count;
    }
  }
  if (count < 10) {
    return {};
  }
  const auto n = static_cast<double>(count);
  const double power = sums[2] - sums[0] * sums[0] / n;
  const double other = sums[4] - sums[1] * sums[1] / n;
  const double both = sums[3] - sums[0] * sums[1] / n;
  constexpr double kLeast = 1e-4;  // rad², of motion in all
  return power > kLeast && other > 0 ? Slope{both / power, both / std::sqrt(power * other)}
                                     : Slope{};
}

/// Commanded and link-side angles against those of the motors.
Checks check_against_motors(const AngleGroup& angles, recording::Recording* recording) {
  std::optional<recording::Samples>& q = recording->*angles.group;
  if (angles.group == &recording::Recording::q_meas || !q || !recording->q_meas) {
    return {};
  }
  Checks checks;
  for (Eigen::Index joint = 0; joint < q->cols(); ++joint) {
    const Slope found = slope(recording->q_meas->col(joint), q->col(joint));
    if (found.correlation > -0.98 || found.value < -1.2 || found.value > -0.8) {
      continue;
    }
    checks.push_back(
        {Severity::error, "recording", "joint.sign",
         fmt::format("{}: q_meas_{} runs against {}_{}: one of them has the wrong sign",
                     recording->file, joint + 1, angles.name, joint + 1),
         "turn the sign of the one that does not follow the model's axis"});
    q->col(joint) *= -1;
  }
  return checks;
}

}  // namespace

Checks check_angles(const model::Robot& robot, recording::Recording* recording) {
  Checks checks;
  for (const AngleGroup& angles : kAngleGroups) {
    if (recording->*angles.group && (recording->*angles.group)->cols() == joint_count(robot)) {
      add(check_degrees(robot, angles, recording), &checks);
    }
  }
  for (const AngleGroup& angles : kAngleGroups) {
    add(check_against_motors(angles, recording), &checks);
  }
  return checks;
}

Checks check_signs_by_limits(const model::Robot& robot, recording::Recording* recording) {
  Checks checks;
  for (const AngleGroup& angles : kAngleGroups) {
    if (recording->*angles.group && (recording->*angles.group)->cols() == joint_count(robot)) {
      add(check_group_by_limits(robot, angles, recording), &checks);
    }
  }
  return checks;
}

}  // namespace flexcomp::check
