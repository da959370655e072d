#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and load.
bool prepare_base_compliance(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.has(simulation::tcp_position) || !is_loaded(observations)) {
    return false;
  }
  const DiagonalCompliance<double>& known = observations.machine.robot.elastic.base_compliance;
  std::vector<Bounds> bounds;
  for (Eigen::Index i = 0; i < 6; ++i) {
    bounds.push_back({-known[i], 1, i < 3 ? 2e-8 : 5e-8});
  }
  hypothesis->set_bounds(bounds);
  return true;
}

}  // namespace

Search search::base_compliance() { return {prepare_base_compliance}; }

}  // namespace flexcomp::diagnosis
