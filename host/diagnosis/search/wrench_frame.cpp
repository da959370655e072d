#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs a wrench.
bool prepare_wrench_frame(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds(std::vector<Bounds>(3, {-3.2, 3.2, 0.05}));
  return observations.has_wrench();
}

}  // namespace

Search search::wrench_frame() { return {prepare_wrench_frame}; }

}  // namespace flexcomp::diagnosis
