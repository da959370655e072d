#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs gravity in the model or, for torques, motion.
bool prepare_payload(const Observations& observations, Hypothesis* hypothesis) {
  const Bounds moment{-300, 300, 1};
  hypothesis->set_bounds({{-500, 1000, 10}, moment, moment, moment});
  return observations.has_weight() || observations.has(simulation::joint_torque);
}

}  // namespace

Search search::payload() { return {prepare_payload}; }

}  // namespace flexcomp::diagnosis
