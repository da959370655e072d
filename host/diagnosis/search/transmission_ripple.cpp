#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Are there angles enough for sines of them to show? Through the few postures of a usual load test
/// some sine goes always.
bool has_many_angles(const Observations& observations) {
  constexpr int kEnough = 200;    // postures; a usual load test has some dozens
  constexpr double kMove = 0.01;  // rad: less is bending
  if (!observations.is_static) {
    return true;
  }
  int postures = 0;
  for (const Simulation& at : observations.simulations) {
    for (Eigen::Index row = 1; row < at.q.rows(); ++row) {
      postures += (at.q.row(row) - at.q.row(row - 1)).cwiseAbs().maxCoeff() > kMove ? 1 : 0;
    }
  }
  return postures >= kEnough;
}

/// Needs the TCP or link encoders, and two periods of motion or, standing, many postures.
bool prepare_transmission_ripple(const Observations& observations, Hypothesis* hypothesis) {
  const Bounds amplitude{-0.01, 0.01, 1e-4};
  hypothesis->set_bounds({amplitude, amplitude, {1, 1000, 0.5}});
  return sees_angles(observations) && has_many_angles(observations);
}

std::vector<Values> seek_transmission_ripple(const Observations& observations,
                                             const Eigen::VectorXd& unexplained,
                                             const Hypothesis& hypothesis) {
  return ripple_orders(observations, hypothesis.joint,
                       observations.angle_residual(hypothesis.joint, unexplained));
}

}  // namespace

// Waves of low orders are left to composed laws: an encoder that is eccentric errs once and twice a
// turn, which the search here is too high for.
Search search::transmission_ripple() {
  return {prepare_transmission_ripple,
          seek_transmission_ripple,
          {{{PlaceKind::joint_angle}, "", {SignalKind::angle}, {"wave of any order"}}}};
}

}  // namespace flexcomp::diagnosis
