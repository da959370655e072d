#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP at places that lie apart.
bool prepare_link_offset(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}, {-0.1, 0.1, 1e-4}});
  return observations.has(simulation::tcp_position) && observations.spans_workspace();
}

}  // namespace

Search search::link_offset() { return {prepare_link_offset}; }

}  // namespace flexcomp::diagnosis
