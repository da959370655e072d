#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs a command without encoders, and motion. Friction turns with the motion: a lagging joint's
/// torque is far from proportion to its lag, and its derivative must be taken over a step that some
/// jumps lie in.
bool prepare_servo_lag(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.follows_command() || observations.is_static) {
    return false;
  }
  const bool jumps = observations.has(simulation::joint_torque);
  hypothesis->set_bounds({{0, 1, jumps ? 0.2 : 0.01}});
  hypothesis->is_sketched = jumps;
  if (jumps) {
    hypothesis->linear = 0;
    hypothesis->starts.clear();
    for (double constant = 2e-3; constant < 0.6; constant *= 1.15) {
      hypothesis->starts.push_back({constant});
    }
  }
  return true;
}

}  // namespace

Search search::servo_lag() { return {prepare_servo_lag}; }

}  // namespace flexcomp::diagnosis
