#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Dry friction: a torque of constant size against the motion (Armstrong-Helouvry, Dupont and
// Canudas de Wit 1994). Needs torques, and motion both ways.
std::vector<Hypothesis> coulomb_friction(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "coulomb_friction";
    hypothesis.joint = joint;
    const auto index = static_cast<std::size_t>(joint - 1);
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.01);
    hypothesis.parameters = {
        {"torque", "N·m", -observations.machine.robot.dynamics[index].coulomb, 100 * size, size}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("joint {} has another dry friction", joint);
    hypothesis.apply = [index](const Values& values, Machine* machine) {
      machine->robot.dynamics[index].coulomb += values[0];
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
