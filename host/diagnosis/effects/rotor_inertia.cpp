#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Inertia of motor and gear, reflected to the joint: torque in proportion to the joint's
// acceleration. Needs torques, and accelerations.
std::vector<Hypothesis> rotor_inertia(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "rotor_inertia";
    hypothesis.joint = joint;
    const auto index = static_cast<std::size_t>(joint - 1);
    const double known = observations.machine.robot.dynamics[index].rotor_inertia;
    hypothesis.parameters = {{"inertia", "kg·m^2", -known, 1e4, std::max(0.1 * known, 1.0)}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("the rotor of joint {} has another inertia", joint);
    hypothesis.apply = [index](const Values& values, Machine* machine) {
      machine->robot.dynamics[index].rotor_inertia += values[0];
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
