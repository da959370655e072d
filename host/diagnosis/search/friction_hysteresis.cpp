#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

std::vector<Values> starts_over(double range, bool has_gap) {
  std::vector<Values> starts;
  for (const double slip : {0.01, 0.03, 0.1}) {
    if (!has_gap) {
      starts.push_back({slip * range});
      continue;
    }
    for (const double gap : {0.01, 0.03, 0.1}) {
      starts.push_back({slip * range, gap * range});
    }
  }
  return starts;
}

/// Needs torques, and reversals of motion.
bool prepare_friction_hysteresis(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kLeastRange = 1e-4;  // rad: some steps of an encoder
  const double range = observations.range(hypothesis->joint);
  if (!sees_moving_torques(observations) || range < kLeastRange) {
    return false;
  }
  const double size = torque_step(observations, hypothesis->joint);
  const bool has_gap = hypothesis->parameters.size() == 3;
  std::vector<Bounds> bounds = {{0, 1e4 * size, size}, {2e-3 * range, 0.5 * range, 1e-3 * range}};
  if (has_gap) {
    bounds.push_back({0, 0.5 * range, 1e-3 * range});
  }
  hypothesis->set_bounds(bounds);
  hypothesis->starts = starts_over(range, has_gap);
  return true;
}

}  // namespace

Search search::friction_hysteresis() {
  return {prepare_friction_hysteresis,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::angle}, {"loop"}}}};
}

}  // namespace flexcomp::diagnosis
