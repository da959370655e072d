#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs a wrench.
bool prepare_wrench_scale(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds(std::vector<Bounds>(hypothesis->parameters.size(), {-0.9, 5, 0.05}));
  return observations.has_wrench();
}

}  // namespace

Search search::wrench_scale() {
  return {prepare_wrench_scale,
          nullptr,
          {{{PlaceKind::sensor_wrench}, "", {SignalKind::tool_wrench}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
