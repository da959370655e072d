#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP or link encoders.
bool prepare_joint_offset(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}});
  return sees_angles(observations);
}

}  // namespace

Search search::joint_offset() {
  return {prepare_joint_offset, nullptr, {}, {PlaceKind::joint_angle}};
}

}  // namespace flexcomp::diagnosis
