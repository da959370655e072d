#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs the TCP, and load. Beyond the last joint it is the tool that gives; a link that is short
/// bends like its springs.
bool prepare_link_flexibility(const Observations& observations, Hypothesis* hypothesis) {
  // m, chosen by judgement: a link about as wide as long is no beam. On the robots here it leaves
  // out the offset behind joint 3 (55 mm) and keeps the shortest link of a wrist (210 mm).
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
