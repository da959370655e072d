#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves.
bool prepare_torque_filter(const Observations& observations, Hypothesis* hypothesis) {
  if (!sees_moving_torques(observations)) {
    return false;
  }
  hypothesis->set_bounds({{0, 1, 1e-3}});
  hypothesis->starts.clear();
  for (double constant = 2e-3; constant < 0.5; constant *= 1.4) {
    hypothesis->starts.push_back({constant});
  }
  return true;
}

}  // namespace

Search search::torque_filter() { return {prepare_torque_filter}; }

}  // namespace flexcomp::diagnosis
