#include "effects/signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace flexcomp::effects {
namespace {

struct OfJoint {
  const char* prefix;
  SignalKind kind;
  const char* unit;  ///< of a joint that turns
  const char* words;
};

constexpr std::array<OfJoint, 5> kOfJoints = {
    {{"q", SignalKind::angle, "rad", "the angle of joint {}"},
     {"v", SignalKind::speed, "rad/s", "the speed of joint {}"},
     {"a", SignalKind::acceleration, "rad/s^2", "the acceleration of joint {}"},
     {"tau", SignalKind::torque, "N·m", "the torque of joint {}"},
     {"load", SignalKind::load, "N·m", "the load on joint {}"}}};

struct OfMachine {
  const char* name;
  SignalKind kind;
  int index;
  const char* unit;
  const char* words;
};

constexpr std::array<OfMachine, 17> kOfMachine = {
    {{"fx", SignalKind::wrench, 0, "N", "the force along x"},
     {"fy", SignalKind::wrench, 1, "N", "the force along y"},
     {"fz", SignalKind::wrench, 2, "N", "the force along z"},
     {"mx", SignalKind::wrench, 3, "N·m", "the moment about x"},
     {"my", SignalKind::wrench, 4, "N·m", "the moment about y"},
     {"mz", SignalKind::wrench, 5, "N·m", "the moment about z"},
     {"fx_tool", SignalKind::tool_wrench, 0, "N", "the force along the tool's x"},
     {"fy_tool", SignalKind::tool_wrench, 1, "N", "the force along the tool's y"},
     {"fz_tool", SignalKind::tool_wrench, 2, "N", "the force along the tool's z"},
     {"mx_tool", SignalKind::tool_wrench, 3, "N·m", "the moment about the tool's x"},
     {"my_tool", SignalKind::tool_wrench, 4, "N·m", "the moment about the tool's y"},
     {"mz_tool", SignalKind::tool_wrench, 5, "N·m", "the moment about the tool's z"},
     {"x", SignalKind::position, 0, "m", "the TCP's place along x"},
     {"y", SignalKind::position, 1, "m", "the TCP's place along y"},
     {"z", SignalKind::position, 2, "m", "the TCP's place along z"},
     {"temp_c", SignalKind::temperature, 0, "K", "the temperature"},
     {"t", SignalKind::time, 0, "s", "time"}}};

/// The torque that balances the load on a joint.
Eigen::VectorXd torque_of(const Prediction& prediction, Eigen::Index column, Loads loads) {
  return loads == Loads::with_inertia && prediction.dynamic_load.cols() > 0
             ? -prediction.dynamic_load.col(column)
             : -prediction.load.col(column);
}

Eigen::VectorXd positions(const Simulation& at, int axis) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(at.bent.size()));
  for (Eigen::Index row = 0; row < all.size(); ++row) {
    all[row] = at.bent[static_cast<std::size_t>(row)].tcp.position[axis];
  }
  return all;
}

/// A component of the wrench, in the tool frame.
Eigen::VectorXd along_tool(const Simulation& at, int component) {
  const int half = component < 3 ? 0 : 3;
  Eigen::VectorXd all(static_cast<Eigen::Index>(at.bent.size()));
  for (Eigen::Index row = 0; row < all.size(); ++row) {
    const Vector3<double> axis =
        at.bent[static_cast<std::size_t>(row)].tcp.rotation.col(component - half);
    all[row] = at.wrench.row(row).segment<3>(half).dot(axis);
  }
  return all;
}

}  // namespace

std::optional<Signal> find_signal(const model::Robot& robot, const std::string& name) {
  for (const OfMachine& each : kOfMachine) {
    if (name == each.name) {
      return Signal{each.kind, each.index, each.unit, each.words};
    }
  }
  for (int joint = 1; joint <= robot.joints(); ++joint) {
    for (const OfJoint& each : kOfJoints) {
      if (name == fmt::format("{}{}", each.prefix, joint)) {
        return Signal{each.kind, joint, model::unit_of(robot.elastic.joint(joint - 1), each.unit),
                      fmt::format(fmt::runtime(each.words), joint)};
      }
    }
  }
  return std::nullopt;
}

std::string signal_names(const model::Robot& robot) {
  std::string names;
  for (const OfJoint& each : kOfJoints) {
    names += fmt::format("{0}1..{0}{1} ", each.prefix, robot.joints());
  }
  for (const OfMachine& each : kOfMachine) {
    names += fmt::format("{} ", each.name);
  }
  names.pop_back();
  return names;
}

Eigen::VectorXd values_of(const Signal& signal, const Scene& scene, const Simulation& at,
                          const Prediction& prediction, Loads loads, double since) {
  const Eigen::Index column = signal.index - 1;
  switch (signal.kind) {
    case SignalKind::angle:
      return at.q.col(column);
    case SignalKind::speed:
      return at.velocity.col(column);
    case SignalKind::acceleration:
      return at.acceleration.col(column);
    case SignalKind::torque:
      return torque_of(prediction, column, loads);
    case SignalKind::load:
      return prediction.load.col(column);
    case SignalKind::wrench:
      return at.wrench.col(signal.index);
    case SignalKind::tool_wrench:
      return along_tool(at, signal.index);
    case SignalKind::position:
      return positions(at, signal.index);
    case SignalKind::temperature:
      return scene.temperature.size() == scene.rows()
                 ? scene.temperature
                 : Eigen::VectorXd::Constant(scene.rows(),
                                             std::numeric_limits<double>::quiet_NaN());
    case SignalKind::time:
      return scene.time.array() - since;
  }
  return {};
}

}  // namespace flexcomp::effects
