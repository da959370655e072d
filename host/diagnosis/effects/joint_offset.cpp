#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Zero of a joint's encoder: the joint stands at its reading plus the offset (Denavit-Hartenberg
// angle error; Mooring, Roth and Driels 1991). Needs the TCP or link encoders.
std::vector<Hypothesis> joint_offset(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!sees_angles(observations)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "joint_offset";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"offset", "rad", -0.1, 0.1, 1e-4}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("the encoder of joint {} has another zero", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->encoder_offset[joint - 1] += values[0];
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
