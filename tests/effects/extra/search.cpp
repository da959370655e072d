#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

bool prepare_test_lift(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}});
  return observations.has(simulation::tcp_position);
}

}  // namespace

Search search::test_lift() { return {prepare_test_lift}; }

}  // namespace flexcomp::diagnosis
