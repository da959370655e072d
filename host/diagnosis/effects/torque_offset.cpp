#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Constant torque, or the zero of a current sensor. Needs torques.
std::vector<Hypothesis> torque_offset(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.has(simulation::joint_torque)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "torque_offset";
    hypothesis.joint = joint;
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.01);
    hypothesis.parameters = {{"torque", "N·m", -100 * size, 100 * size, size}};
    hypothesis.linear = 1;
    hypothesis.statement = fmt::format("the torque of joint {} has another zero", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back(
          {simulation::Term::output,
           [=](const Scene& scene, const Simulation&, Prediction* prediction) {
             add_torque(joint, Eigen::VectorXd::Constant(scene.rows(), values[0]), prediction);
           }});
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
