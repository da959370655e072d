#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques, and motion both ways.
bool prepare_coulomb_friction(const Observations& observations, Hypothesis* hypothesis) {
  if (!sees_moving_torques(observations)) {
    return false;
  }
  const double size = torque_step(observations, hypothesis->joint);
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  hypothesis->set_bounds({{-observations.machine.robot.dynamics[index].coulomb, 100 * size, size}});
  return true;
}

}  // namespace

Search search::coulomb_friction() {
  return {prepare_coulomb_friction,
          nullptr,
          {{{PlaceKind::joint_torque},
            "",
            {SignalKind::speed},
            {"sign", "saturation", "slow saturation", "limit", "step", "soft step"}},
           {{PlaceKind::joint_torque}, "sign(v", {SignalKind::speed}, {"step", "soft step"}}}};
}

}  // namespace flexcomp::diagnosis
