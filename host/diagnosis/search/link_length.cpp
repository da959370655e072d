#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP.
bool prepare_link_length(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.1, 0.1, 1e-4}});
  return observations.has(simulation::tcp_position);
}

}  // namespace

Search search::link_length() { return {prepare_link_length}; }

}  // namespace flexcomp::diagnosis
