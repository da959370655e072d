#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Cubic torque-deflection curve of a joint, deflection = c1 tau + c3 tau^3, softening above zero
// and hardening below (strain-wave and cycloidal gears; Albu-Schaeffer 2002). Needs the TCP or link
// encoders, and load of changing size.
std::vector<Hypothesis> nonlinear_stiffness(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!sees_angles(observations)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "nonlinear_stiffness";
    hypothesis.joint = joint;
    const double load = std::max(observations.largest_load(joint), 1.0);
    const double known =
        observations.machine.robot.elastic.joints[static_cast<std::size_t>(joint - 1)].compliance;
    const double size = known / (load * load);
    hypothesis.parameters = {
        {"cubic_compliance", "rad/(N·m)^3", -2 * size, 1e3 * size, 0.1 * size}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("joint {} winds up out of proportion to its torque", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->robot.elastic.joints[static_cast<std::size_t>(joint - 1)].cubic_compliance +=
          values[0];
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
