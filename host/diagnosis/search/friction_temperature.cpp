#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Has the model friction at a joint (from 1 on), or at any (0)?
bool has_friction(const model::Robot& robot, int joint) {
  const auto rubs = [](const model::JointDynamics& motor) {
    return motor.viscous + motor.coulomb > 0;
  };
  return joint > 0 ? rubs(robot.dynamics[static_cast<std::size_t>(joint - 1)])
                   : std::any_of(robot.dynamics.begin(), robot.dynamics.end(), rubs);
}

/// Needs torques of a robot that moves, temperatures, and friction that could change with these.
bool prepare_friction_temperature(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.2, 0.2, 1e-3}});
  return sees_moving_torques(observations) && observations.scenes.front().temperature.size() > 0 &&
         has_friction(observations.machine.robot, hypothesis->joint);
}

}  // namespace

Search search::friction_temperature() {
  return {prepare_friction_temperature,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::temperature}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
