#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

bool prepare_sloping_floor(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}});
  return observations.has(simulation::tcp_position);
}

}  // namespace

Search search::sloping_floor() { return {prepare_sloping_floor}; }

}  // namespace flexcomp::diagnosis
