#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves.
bool prepare_link_inertia(const Observations& observations, Hypothesis* hypothesis) {
  const auto index = static_cast<std::size_t>(hypothesis->joint - 1);
  const model::Robot& robot = observations.machine.robot;
  const double size = std::max(robot.link_inertia[index].trace(), 1e-3);
  hypothesis->set_bounds(std::vector<Bounds>(6, {-100 * size, 100 * size, 0.1 * size}));
  return sees_moving_torques(observations);
}

}  // namespace

Search search::link_inertia() { return {prepare_link_inertia}; }

}  // namespace flexcomp::diagnosis
