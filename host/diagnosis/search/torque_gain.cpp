#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of a robot that moves.
bool prepare_torque_gain(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{-0.5, 1, 0.02}});
  return sees_moving_torques(observations);
}

}  // namespace

Search search::torque_gain() {
  return {prepare_torque_gain,
          nullptr,
          {{{PlaceKind::joint_torque}, "", {SignalKind::torque}, {"line"}}}};
}

}  // namespace flexcomp::diagnosis
