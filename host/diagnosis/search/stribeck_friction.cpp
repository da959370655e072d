#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques, and slow motion.
bool prepare_stribeck_friction(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kLeastSpeed = 1e-3;  // rad/s: below it the angles' noise makes the direction
  const double speed = observations.largest_speed(hypothesis->joint);
  if (!sees_moving_torques(observations) || speed < kLeastSpeed) {
    return false;
  }
  const double size = torque_step(observations, hypothesis->joint);
  hypothesis->set_bounds({{0, 100 * size, size}, {5e-3 * speed, 0.4 * speed, 0.01 * speed}});
  hypothesis->starts = starts_at({0.02, 0.05, 0.1, 0.18, 0.3}, speed);
  return true;
}

}  // namespace

Search search::stribeck_friction() {
  return {
      prepare_stribeck_friction,
      nullptr,
      {{{PlaceKind::joint_torque},
        "sign(v",
        {SignalKind::speed},
        {"line", "size", "parabola", "saturation", "slow saturation", "limit", "bump", "growth"}}}};
}

}  // namespace flexcomp::diagnosis
