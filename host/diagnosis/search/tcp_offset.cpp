#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and rotations of the tool.
bool prepare_tcp_offset(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds(std::vector<Bounds>(3, {-10, 10, 1e-4}));
  return observations.has(simulation::tcp_position);
}

}  // namespace

Search search::tcp_offset() { return {prepare_tcp_offset}; }

}  // namespace flexcomp::diagnosis
