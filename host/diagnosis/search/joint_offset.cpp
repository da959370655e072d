#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, link encoders, or torques that hold weights: these hang elsewhere than it reads.
bool prepare_joint_offset(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}});
  return sees_angles(observations) ||
         (observations.has(simulation::joint_torque) && observations.has_weight());
}

}  // namespace

Search search::joint_offset() {
  return {prepare_joint_offset, nullptr, {}, {PlaceKind::joint_angle}};
}

}  // namespace flexcomp::diagnosis
