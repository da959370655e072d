#include "diagnosis/search/search.hpp"
#include "effects/terms.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP or link encoders, and reversals of load or motion.
bool prepare_backlash(const Observations& observations, Hypothesis* hypothesis) {
  const Bounds gap{0, 0.05, 1e-4};
  const double load = observations.largest_load(hypothesis->joint);
  const bool is_by_motion = hypothesis->law->form == "motion";
  if (!sees_angles(observations) ||
      (is_by_motion ? observations.is_static : !(load > effects::kLeastFlankLoad))) {
    return false;
  }
  if (is_by_motion) {
    hypothesis->set_bounds({gap});
    return true;
  }
  hypothesis->set_bounds({gap, {1e-3 * load, 0.3 * load, 1e-3 * load}});
  hypothesis->starts = starts_at({0.003, 0.01, 0.015, 0.02, 0.03, 0.04, 0.07, 0.12}, load);
  return true;
}

}  // namespace

Search search::backlash() {
  return {
      prepare_backlash, nullptr, {{{PlaceKind::joint_angle}, "", {SignalKind::angle}, {"loop"}}}};
}

}  // namespace flexcomp::diagnosis
