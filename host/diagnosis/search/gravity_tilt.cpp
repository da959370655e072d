#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs gravity in the model.
bool prepare_gravity_tilt(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.2, 0.2, 1e-3}, {-0.2, 0.2, 1e-3}});
  return observations.has_weight();
}

}  // namespace

Search search::gravity_tilt() { return {prepare_gravity_tilt}; }

}  // namespace flexcomp::diagnosis
