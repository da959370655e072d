#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Largest yield torque that is tried, over the joint's load. Elements that slide one after another
/// reach to twice the load, with that still half of them stick; if they reached farther the loop
/// would pass for a softer spring.
double reach(const std::string& form) { return form.rfind("prandtl_ishlinskii", 0) == 0 ? 0.5 : 1; }

/// Needs the TCP or link encoders, and a load that rises and falls.
bool prepare_hysteresis(const Observations& observations, Hypothesis* hypothesis) {
  constexpr double kLeastLoad = 0.01;  // N·m: less is no load
  const double load = observations.largest_load(hypothesis->joint);
  if (!sees_angles(observations) || load < kLeastLoad) {
    return false;
  }
  const double scale = reach(hypothesis->law->form) * load;
  hypothesis->set_bounds({{0, 0.05, 1e-4}, {0.01 * scale, scale, 0.02 * scale}});
  hypothesis->starts = starts_at({0.05, 0.1, 0.18, 0.3, 0.5, 0.9}, scale);
  return true;
}

}  // namespace

Search search::hysteresis() {
  return {
      prepare_hysteresis,
      nullptr,
      {{{PlaceKind::joint_angle}, "", {SignalKind::load, SignalKind::torque}, {"loop", "play"}}}};
}

}  // namespace flexcomp::diagnosis
