#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Linear compliance of a joint that differs from the model's: it winds up by more or less per
// torque (virtual-joint model, Klimchik et al. 2017). Needs the TCP or link encoders, and load.
std::vector<Hypothesis> joint_stiffness(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!sees_angles(observations)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "joint_stiffness";
    hypothesis.joint = joint;
    const double known =
        observations.machine.robot.elastic.joints[static_cast<std::size_t>(joint - 1)].compliance;
    hypothesis.parameters = {
        {"compliance_change", "rad/(N·m)", -known, 1, std::max(0.2 * known, 1e-9)}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("the spring of joint {} has another stiffness", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->robot.elastic.joints[static_cast<std::size_t>(joint - 1)].compliance += values[0];
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
