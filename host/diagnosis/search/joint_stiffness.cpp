#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP or link encoders, and load.
bool prepare_joint_stiffness(const Observations& observations, Hypothesis* hypothesis) {
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const double known = observations.machine.robot.elastic.joints[index].compliance;
  hypothesis->set_bounds({{-known, 1, std::max(0.2 * known, 1e-9)}});
  return sees_angles(observations);
}

}  // namespace

Search search::joint_stiffness() {
  return {prepare_joint_stiffness,
          nullptr,
          {{{PlaceKind::joint_angle}, "", {SignalKind::load, SignalKind::torque}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
