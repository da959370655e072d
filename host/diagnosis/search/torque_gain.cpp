#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves, and temperatures for a gain by these.
bool prepare_torque_gain(const Observations& observations, Hypothesis* hypothesis) {
  if (!hypothesis->traits().needs_temperature) {
    hypothesis->set_bounds({{-0.5, 1, 0.02}});
    return sees_moving_torques(observations);
  }
  hypothesis->set_bounds({{-0.02, 0.02, 1e-4}});
  return sees_moving_torques(observations) && observations.scenes.front().temperature.size() > 0;
}

}  // namespace

Search search::torque_gain() {
  return {prepare_torque_gain,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::torque}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
