#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Friction in proportion to speed, the same both ways or with a coefficient for each (Armstrong-
// Helouvry, Dupont and Canudas de Wit 1994). In no direction does friction drive: no coefficient
// falls below zero in all. Needs torques, and several speeds.
std::vector<Hypothesis> viscous_friction(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "viscous_friction";
    hypothesis.joint = joint;
    const auto index = static_cast<std::size_t>(joint - 1);
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.01) /
                        std::max(observations.largest_speed(joint), 1e-3);
    const double known = observations.machine.robot.dynamics[index].viscous;
    hypothesis.parameters = {{"coefficient", "N·m·s/rad", -known, 100 * size, size}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("joint {} has another viscous friction", joint);
    hypothesis.apply = [index](const Values& values, Machine* machine) {
      machine->robot.dynamics[index].viscous += values[0];
    };
    all.push_back(hypothesis);

    hypothesis.form = "by_direction";
    hypothesis.parameters = {{"forward", "N·m·s/rad", -known, 100 * size, size},
                             {"backward", "N·m·s/rad", -known, 100 * size, size}};
    hypothesis.linear = 2;
    hypothesis.alters_model = false;
    hypothesis.statement =
        fmt::format("joint {} has another viscous friction, unlike in its two directions", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back(
          {simulation::Term::output,
           [=](const Scene&, const Simulation& at, Prediction* prediction) {
             const Eigen::VectorXd speed = at.velocity.col(joint - 1);
             add_torque(joint, values[0] * speed.cwiseMax(0) + values[1] * speed.cwiseMin(0),
                        prediction);
           }});
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
