#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP at places that lie apart.
bool prepare_base_frame(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.has(simulation::tcp_position)) {
    return false;
  }
  hypothesis->set_bounds(std::vector<Bounds>(6, {-0.1, 0.1, 1e-4}));
  if (!observations.spans_workspace()) {
    hypothesis->starts.clear();
  }
  return true;
}

}  // namespace

Search search::base_frame() { return {prepare_base_frame}; }

}  // namespace flexcomp::diagnosis
