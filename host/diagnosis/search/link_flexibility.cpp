#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and load. Beyond the last joint it is the tool that gives; a link that is short
/// bends like its springs.
bool prepare_link_flexibility(const Observations& observations, Hypothesis* hypothesis) {
  // m, chosen by judgement: about as wide as an arm's links, which are no beams if they are no
  // longer. Of two forms that show alike, one then is not tried.
  constexpr double kShort = 0.2;
  if (!observations.has(simulation::tcp_position) || !is_loaded(observations) ||
      hypothesis->joint == observations.machine.robot.joints()) {
    return false;
  }
  const auto next = static_cast<std::size_t>(hypothesis->joint);
  const double length = observations.machine.robot.elastic.joints[next].origin.position.norm();
  hypothesis->set_bounds(std::vector<Bounds>(hypothesis->parameters.size(), {0, 1, 1e-7}));
  return hypothesis->law->form != "beam" || length >= kShort;
}

}  // namespace

Search search::link_flexibility() { return {prepare_link_flexibility}; }

}  // namespace flexcomp::diagnosis
