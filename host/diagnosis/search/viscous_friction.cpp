#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques, and several speeds. Friction drives in no direction: no coefficient falls below
/// zero in all.
bool prepare_viscous_friction(const Observations& observations, Hypothesis* hypothesis) {
  if (!sees_moving_torques(observations)) {
    return false;
  }
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const double size = torque_step(observations, hypothesis->joint) /
                      std::max(observations.largest_speed(hypothesis->joint), 1e-3);
  const double known = observations.machine.robot.dynamics[index].viscous;
  hypothesis->set_bounds(
      std::vector<Bounds>(hypothesis->parameters.size(), {-known, 100 * size, size}));
  return true;
}

}  // namespace

Search search::viscous_friction() {
  return {prepare_viscous_friction,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::speed}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
