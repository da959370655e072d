#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves, and, where these are the joints', a motor with friction or
/// inertia to show it.
bool prepare_transmission(const Observations& observations, Hypothesis* hypothesis) {
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const model::JointDynamics& motor = observations.machine.robot.dynamics[index];
  hypothesis->set_bounds({{-3, 3, 0.1}});
  hypothesis->starts = {{1.0}, {-1.0}, {0.3}, {-0.3}};
  return sees_moving_torques(observations) &&
         (hypothesis->law->form == "motor_torques" ||
          motor.viscous + motor.coulomb + motor.rotor_inertia > 0);
}

}  // namespace

Search search::transmission() {
  return {prepare_transmission,
          nullptr,
          {{{PlaceKind::joint_angle}, "", {SignalKind::angle}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
