#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and a wrench; and a payload's weight to tell what hangs on the spring.
bool prepare_tool_compliance(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.has(simulation::tcp_position) || !observations.has_wrench()) {
    return false;
  }
  const bool is_holder = !hypothesis->law->form.empty();
  if (is_holder &&
      (!observations.has_weight() || observations.machine.robot.elastic.payload_mass == 0)) {
    return false;
  }
  const DiagonalCompliance<double>& known = observations.machine.robot.elastic.tool_compliance;
  std::vector<Bounds> bounds;
  for (Eigen::Index i = 0; i < 3; ++i) {
    bounds.push_back({is_holder ? 0 : -known[i], 1, 1e-7});
  }
  hypothesis->set_bounds(bounds);
  return true;
}

}  // namespace

Search search::tool_compliance() { return {prepare_tool_compliance}; }

}  // namespace flexcomp::diagnosis
