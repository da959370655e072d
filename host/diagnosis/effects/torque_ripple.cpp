#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Torque of a drive that is a sinusoid of the joint's angle (cogging, torque ripple of the motor
// seen through the gear; Holtz and Springob 1996). Needs torques, and two periods of motion.
std::vector<Hypothesis> torque_ripple(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "torque_ripple";
    hypothesis.joint = joint;
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.1);
    hypothesis.parameters = {{"sine", "N·m", -100 * size, 100 * size, size},
                             {"cosine", "N·m", -100 * size, 100 * size, size},
                             {"order", "1", 1, 1000, 0.5}};
    hypothesis.linear = 2;
    hypothesis.is_sought = true;
    hypothesis.starts = ripple_orders(observations, joint, observations.torque_residual(joint));
    hypothesis.statement = fmt::format("the torque of joint {} has a periodic part", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back({simulation::Term::output,
                                [=](const Scene&, const Simulation& at, Prediction* prediction) {
                                  add_torque(joint, ripple(at, joint, values), prediction);
                                }});
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
