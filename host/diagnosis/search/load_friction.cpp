#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques of joints that move.
bool prepare_load_friction(const Observations& observations, Hypothesis* hypothesis) {
  hypothesis->set_bounds({{0, 0.5, 0.01}});
  return sees_moving_torques(observations);
}

}  // namespace

Search search::load_friction() {
  return {prepare_load_friction,
          nullptr,
          {{{PlaceKind::joint_torque},
            "sign(v",
            {SignalKind::load, SignalKind::torque},
            {"size", "line", "square", "signed square"}}}};
}

}  // namespace flexcomp::diagnosis
