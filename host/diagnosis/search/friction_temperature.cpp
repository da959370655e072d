#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves, and temperatures.
bool prepare_friction_temperature(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.2, 0.2, 1e-3}});
  return sees_moving_torques(observations) && observations.scenes.front().temperature.size() > 0;
}

}  // namespace

Search search::friction_temperature() {
  return {prepare_friction_temperature,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::temperature}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
