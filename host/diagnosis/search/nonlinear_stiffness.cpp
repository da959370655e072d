#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP or link encoders, and load of changing size.
bool prepare_nonlinear_stiffness(const Observations& observations, Hypothesis* hypothesis) {
  if (!sees_angles(observations)) {
    return false;
  }
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const double load = std::max(observations.largest_load(hypothesis->joint), 1.0);
  const double known = observations.machine.robot.elastic.joints[index].compliance;
  const double size = known / (load * load);
  hypothesis->set_bounds({{-2 * size, 1e3 * size, 0.1 * size}});
  return true;
}

}  // namespace

Search search::nonlinear_stiffness() {
  return {prepare_nonlinear_stiffness,
          nullptr,
          {{{PlaceKind::joint_angle},
            "",
            {SignalKind::load, SignalKind::torque},
            {"cube", "odd cubic", "signed square"}}}};
}

}  // namespace flexcomp::diagnosis
