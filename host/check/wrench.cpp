#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "check/arm.hpp"
#include "check/loads.hpp"
#include "check/regression.hpp"
#include "simulation/machine.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::check {
namespace {

using simulation::Scene;

constexpr Eigen::Index kMostWrenchRows = 1500;  // time: each is simulated
constexpr Eigen::Index kFewestWrenchRows = 12;  // for two columns, in proportion for more

/// A target by the wrench, in the first column, and by what else may be in it.
struct WrenchEvidence {
  const char* what = nullptr;  ///< what shows it
  Eigen::MatrixXd in_base;     ///< columns, with the wrench in the base frame
  Eigen::VectorXd in_tool;     ///< the first column with the wrench turned with the tool
  Eigen::VectorXd target;
};

/// Wrench as it would be in the base frame if the recording's were in the tool's.
Wrench<double> turned(const Wrench<double>& wrench, const Matrix3<double>& rotation) {
  Wrench<double> result;
  result << rotation * wrench.head<3>(), rotation * wrench.tail<3>();
  return result;
}

/// The TCP's displacement: by the wrench's springs, beside a frame and a place on the tool that are
/// a little off.
WrenchEvidence by_position(const model::Robot& robot, const Scene& scene,
                           const simulation::Simulation& simulated) {
  std::vector<Eigen::Index> rows;
  const Eigen::MatrixXd& measured = scene.measured[simulation::tcp_position];
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    if (measured.row(row).allFinite()) {
      rows.push_back(row);
    }
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  WrenchEvidence evidence;
  evidence.what = "the TCP";
  evidence.in_base.resize(3 * count, 10);
  evidence.in_tool.resize(3 * count);
  evidence.target.resize(3 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = rows[static_cast<std::size_t>(i)];
    const Pose<double> tcp = tcp_at(robot, scene.q.row(row));
    const auto& compliance = simulated.compliance[static_cast<std::size_t>(row)];
    const Wrench<double> wrench = scene.wrench.row(row).transpose();
    // By components, so that neighbours in the regression are neighbours in time.
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Index at = axis * count + i;
      evidence.target[at] = measured(row, axis) - tcp.position[axis];
      evidence.in_base(at, 0) = compliance.row(axis).dot(wrench);
      evidence.in_tool[at] = compliance.row(axis).dot(turned(wrench, tcp.rotation));
      const Vector3<double> unit = Vector3<double>::Unit(axis);
      evidence.in_base.block<1, 3>(at, 1) = unit.transpose();
      evidence.in_base.block<1, 3>(at, 4) = tcp.position.cross(unit).transpose();
      evidence.in_base.block<1, 3>(at, 7) = unit.transpose() * tcp.rotation;
    }
  }
  return evidence;
}

/// A joint's deflection or torque: by the wrench, beside weight and inertia and a zero.
WrenchEvidence by_joint(const model::Robot& robot, const Scene& scene, simulation::Channel channel,
                        Eigen::Index joint) {
  const Eigen::MatrixXd& measured = scene.measured[channel];
  const bool is_torque = channel == simulation::joint_torque;
  const double compliance = joint_of(robot, joint).compliance;
  const model::Robot weighty =
      robot.elastic.gravity.norm() > 0 ? robot : with_gravity(robot, Vector3<double>(0, 0, -9.81));
  const Eigen::RowVectorXd rest = Eigen::RowVectorXd::Zero(scene.q.cols());
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    if (std::isfinite(measured(row, joint)) && (scene.is_static || scene.stands(row, joint) == 0)) {
      rows.push_back(row);
    }
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  WrenchEvidence evidence;
  evidence.what = is_torque ? "the joints' torques" : "the joints' deflection";
  evidence.in_base.resize(count, 6);
  evidence.in_tool.resize(count);
  evidence.target.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = rows[static_cast<std::size_t>(i)];
    const Eigen::RowVectorXd q = scene.q.row(row);
    const Eigen::VectorXd lever = jacobian_at(robot, q).col(joint);
    const Wrench<double> wrench = scene.wrench.row(row).transpose();
    const double sign = is_torque ? -1 : compliance;
    const double velocity = scene.velocity(row, joint);
    const double weight = torque_at(weighty, q, rest, rest)[joint];
    evidence.target[i] = measured(row, joint);
    evidence.in_base.row(i) << sign * lever.dot(wrench), weight,
        torque_at(weighty, q, scene.velocity.row(row), scene.acceleration.row(row))[joint] - weight,
        velocity,
        velocity > 0   ? 1
        : velocity < 0 ? -1
                       : 0,
        1;
    evidence.in_tool[i] = sign * lever.dot(turned(wrench, tcp_at(robot, q).rotation));
  }
  return evidence;
}

/// The evidence on the wrench.
struct Answer {
  const char* what = nullptr;
  double slope = 0;  ///< measured over predicted; 0 where it does not tell
  double tool_slope =
      0;  ///< the same with the wrench in the tool's frame, where that fits far better
  double partial = 0;
};

Answer ask(const WrenchEvidence& evidence) {
  constexpr double kLeastPartial = 0.5;  // correlation, chosen by judgement: half is something else
  constexpr double kFarBetter = 0.4;     // of the squares left, for the less usual frame
  Answer answer;
  answer.what = evidence.what;
  if (evidence.target.size() < kFewestWrenchRows * evidence.in_base.cols() / 2 ||
      !(evidence.in_base.col(0).norm() > 0)) {
    return answer;
  }
  const Regression in_base = regress(evidence.in_base, evidence.target);
  Eigen::MatrixXd columns = evidence.in_base;
  columns.col(0) = evidence.in_tool;
  const Regression in_tool = regress(columns, evidence.target);
  if (in_base.is_told(0, kLeastPartial)) {
    answer.slope = in_base.value[0];
    answer.partial = in_base.partial[0];
  }
  if (in_tool.is_told(0, 0.9) && in_tool.left < kFarBetter * in_base.left) {
    answer.tool_slope = in_tool.value[0];
  }
  return answer;
}

bool tells(const Answer& answer) { return answer.slope != 0 || answer.tool_slope != 0; }

/// Answers of the most direct evidence that tells anything: what bends, before what is driven.
std::vector<Answer> ask_all(const model::Robot& robot, const Scene& scene,
                            const simulation::Simulation& simulated) {
  std::vector<Answer> answers;
  if (scene.has(simulation::tcp_position)) {
    answers.push_back(ask(by_position(robot, scene, simulated)));
  }
  for (const simulation::Channel channel :
       {simulation::joint_deflection, simulation::joint_torque}) {
    if (std::any_of(answers.begin(), answers.end(), tells)) {
      return answers;
    }
    for (Eigen::Index joint = 0; scene.has(channel) && joint < scene.q.cols(); ++joint) {
      answers.push_back(ask(by_joint(robot, scene, channel, joint)));
    }
  }
  return answers;
}

/// The answers that agree on something outvote those that disagree.
template <typename Says>
const Answer* majority(const std::vector<Answer>& answers, const Says& says) {
  const Answer* first = nullptr;
  int votes = 0;
  for (const Answer& each : answers) {
    if (!tells(each)) {
      continue;
    }
    votes += says(each) ? 1 : -1;
    first = says(each) && first == nullptr ? &each : first;
  }
  return votes > 0 ? first : nullptr;
}

}  // namespace

Checks check_wrench(const model::Robot& robot, const recording::Recording& recording) {
  // Times what the model says, chosen by judgement: a model's springs may be several times too soft
  // or too stiff, a unit is off by 1000, and a slope near nothing has no sign.
  constexpr double kLeastSlope = 0.15;
  constexpr double kOrders = 30;
  const bool shows = recording.position || recording.tau || (recording.q_link && recording.q_meas);
  const bool has_angles = recording.q_meas || recording.q_cmd;
  if (!recording.wrench || !shows || !has_angles) {
    return {};
  }
  simulation::Preparation preparation;
  const Scene scene = simulation::prepare(recording, kMostWrenchRows, &preparation);
  if (scene.wrench.isZero(0)) {
    return {};
  }
  const simulation::Machine machine(robot);
  simulation::Wanted wanted;
  wanted.channel = {true, false, false};
  const auto said = [&](const char* name, const std::string& what, const char* fix) -> Checks {
    return {{Severity::error, "recording", name, scene.file + ": " + what, fix}};
  };
  simulation::Simulation simulated;
  try {
    simulated = simulation::simulate(machine, scene, wanted);
  } catch (const simulation::NoRest&) {
    return said("units.wrench",
                fmt::format("under forces up to {:.4g} N and moments up to {:.4g} N·m the robot "
                            "does not come to rest",
                            scene.wrench.leftCols<3>().rowwise().norm().maxCoeff(),
                            scene.wrench.rightCols<3>().rowwise().norm().maxCoeff()),
                "give forces in N and moments in N·m; if they are, the compliances are far too "
                "large");
  }
  const std::vector<Answer> answers = ask_all(robot, scene, simulated);
  if (const Answer* tool =
          majority(answers, [](const Answer& a) { return a.tool_slope > kLeastSlope; })) {
    return said("wrench.frame",
                fmt::format("{} bends as if the wrench were given in the tool's frame", tool->what),
                "turn force and moment into the robot's base frame");
  }
  if (const Answer* tool =
          majority(answers, [](const Answer& a) { return a.tool_slope < -kLeastSlope; })) {
    return said("wrench.sign",
                fmt::format("{} bends against the wrench, as if it were that of the tool on the "
                            "work, in the tool's frame",
                            tool->what),
                "turn the sign of force and moment, and turn them into the robot's base frame");
  }
  if (const Answer* against =
          majority(answers, [](const Answer& a) { return a.slope < -kLeastSlope; })) {
    return said("wrench.sign",
                fmt::format("{} bends against the wrench ({:.2g} times what the model says): it "
                            "looks like the force of the tool on the work",
                            against->what, against->slope),
                "turn the sign of fx to mz: they act on the tool");
  }
  if (const Answer* far = majority(answers, [](const Answer& a) {
        return a.slope > kOrders || (a.slope > 0 && a.slope < 1 / kOrders);
      })) {
    return said("units.wrench",
                fmt::format("{} bends {:.3g} times as much as the model says under this wrench",
                            far->what, far->slope),
                "give forces in N and moments in N·m; if they are, the compliances are far off");
  }
  return {};
}

}  // namespace flexcomp::check
