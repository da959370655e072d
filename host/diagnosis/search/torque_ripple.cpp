#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Needs torques, and two periods of motion.
bool prepare_torque_ripple(const Observations& observations, Hypothesis* hypothesis) {
  const double size = torque_step(observations, hypothesis->joint, 0.1);
  const Bounds amplitude{-100 * size, 100 * size, size};
  hypothesis->set_bounds({amplitude, amplitude, {1, 1000, 0.5}});
  return sees_moving_torques(observations);
}

std::vector<Values> seek_torque_ripple(const Observations& observations,
                                       const Eigen::VectorXd& unexplained,
                                       const Hypothesis& hypothesis) {
  return ripple_orders(observations, hypothesis.joint,
                       observations.torque_residual(hypothesis.joint, unexplained));
}

}  // namespace

Search search::torque_ripple() {
  return {prepare_torque_ripple,
          seek_torque_ripple,
          {{{PlaceKind::joint_torque},
            "",
            {SignalKind::angle},
            {"wave", "wave of any order", "two waves"}}}};
}

}  // namespace flexcomp::diagnosis
