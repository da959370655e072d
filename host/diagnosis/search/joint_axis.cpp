#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and motion of the joints beyond. The axis of joint 1 is the base frame's.
bool prepare_joint_axis(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.has(simulation::tcp_position) || hypothesis->joint == 1) {
    return false;
  }
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}, {-0.1, 0.1, 1e-4}});
  if (!observations.spans_workspace()) {
    hypothesis->starts.clear();
  }
  return true;
}

}  // namespace

Search search::joint_axis() { return {prepare_joint_axis}; }

}  // namespace flexcomp::diagnosis
