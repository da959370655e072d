#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques.
bool prepare_torque_offset(const Observations& observations, Hypothesis* hypothesis) {
  const double size = torque_step(observations, hypothesis->joint);
  hypothesis->set_bounds({{-100 * size, 100 * size, size}});
  return observations.has(simulation::joint_torque);
}

}  // namespace

Search search::torque_offset() {
  return {prepare_torque_offset, nullptr, {}, {PlaceKind::joint_torque, PlaceKind::sensor_torque}};
}

}  // namespace flexcomp::diagnosis
