#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques, and accelerations.
bool prepare_rotor_inertia(const Observations& observations, Hypothesis* hypothesis) {
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const double known = observations.machine.robot.dynamics[index].rotor_inertia;
  hypothesis->set_bounds({{-known, 1e4, std::max(0.1 * known, 1.0)}});
  return sees_moving_torques(observations);
}

}  // namespace

Search search::rotor_inertia() {
  return {prepare_rotor_inertia,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::acceleration}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
