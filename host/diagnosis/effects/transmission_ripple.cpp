#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Are there angles enough for sines of them to show? Through the few postures of a usual load test
/// some sine goes always.
bool has_many_angles(const Observations& observations) {
  constexpr int kEnough = 200;
  constexpr double kMove = 0.01;  // rad
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

}  // namespace

// Position error of a gear, a sinusoid of the joint's angle (eccentricity, tooth pitch; Sweet and
// Good 1985 for robots' gears), simulated along the motion. Needs the TCP or link encoders, and two
// periods of motion, or, standing, many postures.
std::vector<Hypothesis> transmission_ripple(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(sees_angles(observations) && has_many_angles(observations))) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "transmission_ripple";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"sine", "rad", -0.01, 0.01, 1e-4},
                             {"cosine", "rad", -0.01, 0.01, 1e-4},
                             {"order", "1", 1, 1000, 0.5}};
    hypothesis.linear = 2;
    hypothesis.is_sought = true;
    hypothesis.starts = ripple_orders(observations, joint, observations.angle_residual(joint));
    hypothesis.statement = fmt::format("the gear of joint {} has a periodic error", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back({simulation::Term::output,
                                [=](const Scene&, const Simulation& at, Prediction* prediction) {
                                  add_joint_angle(at, joint, ripple(at, joint, values), prediction);
                                }});
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
