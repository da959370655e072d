#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs gravity in the model or, for torques, motion.
bool prepare_link_mass(const Observations& observations, Hypothesis* hypothesis) {
  if (!observations.has_weight() && !observations.has(simulation::joint_torque)) {
    return false;
  }
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const model::ChainJoint& link = observations.machine.robot.elastic.joints[index];
  if (hypothesis->law->form == "body") {
    hypothesis->set_bounds({{-0.95 * link.mass, 10 * link.mass, 0.1 * link.mass}});
    return true;
  }
  // A moment that is more than the link's own (or much for what can be mounted on a small one) is
  // no mass: a balancer pulls so.
  const double most = std::max(50.0, link.mass * link.center_of_mass.norm());
  const Bounds moment{-most, most, 1};
  hypothesis->set_bounds({{-0.95 * link.mass, 2000, 10}, moment, moment, moment});
  return true;
}

}  // namespace

Search search::link_mass() { return {prepare_link_mass}; }

}  // namespace flexcomp::diagnosis
