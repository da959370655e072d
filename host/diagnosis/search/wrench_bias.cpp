#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs a wrench, and rotations of the tool or the TCP without load elsewhere.
bool prepare_wrench_bias(const Observations& observations, Hypothesis* hypothesis) {
  const Bounds force{-1e5, 1e5, 20};
  const Bounds moment{-1e5, 1e5, 5};
  hypothesis->set_bounds({force, force, force, moment, moment, moment});
  return observations.has_wrench();
}

}  // namespace

Search search::wrench_bias() { return {prepare_wrench_bias}; }

}  // namespace flexcomp::diagnosis
