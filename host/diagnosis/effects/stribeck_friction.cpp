#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

simulation::Term slow_friction(int joint, double excess, double stribeck_speed) {
  return {simulation::Term::output,
          [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::ArrayXd speed = at.velocity.col(joint - 1).array();
            const Eigen::ArrayXd direction = speed.unaryExpr([](double value) {
              return static_cast<double>(simulation::direction_of_motion(value));
            });
            add_torque(joint, excess * (-(speed / stribeck_speed).square()).exp() * direction,
                       prediction);
          }};
}

}  // namespace

// Friction that falls with speed at low speed, beyond dry friction: excess exp(-(speed/stribeck
// speed)^2) against the motion (Armstrong-Helouvry, Dupont and Canudas de Wit 1994). Needs torques,
// and slow motion.
std::vector<Hypothesis> stribeck_friction(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!(observations.has(simulation::joint_torque) && !observations.is_static)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "stribeck_friction";
    hypothesis.joint = joint;
    const double size = std::max(0.02 * observations.largest_torque(joint), 0.01);
    const double speed = observations.largest_speed(joint);
    if (speed < 1e-3) {
      continue;
    }
    hypothesis.parameters = {{"excess", "N·m", 0, 100 * size, size},
                             {"speed", "rad/s", 5e-3 * speed, 0.4 * speed, 0.01 * speed}};
    hypothesis.linear = 1;
    hypothesis.starts.clear();
    for (const double share : {0.02, 0.05, 0.1, 0.18, 0.3}) {
      hypothesis.starts.push_back({share * speed});
    }
    hypothesis.statement = fmt::format("the friction of joint {} rises at low speed", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back(slow_friction(joint, values[0], values[1]));
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
