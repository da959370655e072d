#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Its torque comes so much later, to begin with, and its angle by the lag itself.
simulation::Term late_joints(int first, int last, double constant) {
  return {simulation::Term::output,
          [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
            for (int joint = first; joint <= last && !scene.is_static; ++joint) {
              const Eigen::VectorXd angle = at.q.col(joint - 1);
              add_joint_angle(at, joint, simulation::lag(scene.time, angle, constant) - angle,
                              prediction);
              if (torque.cols() > 0) {
                torque.col(joint - 1) =
                    simulation::delayed(scene.time, torque.col(joint - 1), constant);
              }
            }
          }};
}

}  // namespace

// A joint, or every joint, follows its command late, as a first-order lag T x' + x = command
// (Siciliano et al. 2009, section 8), simulated along the command. Needs a command without
// encoders, and motion.
std::vector<Hypothesis> servo_lag(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.follows_command() || observations.is_static) {
    return all;
  }
  std::vector<Values> guesses;
  for (double constant = 2e-3; constant < 0.6; constant *= 1.15) {
    guesses.push_back({constant});
  }
  // Friction turns with the motion: a lagging joint's torque is far from proportion to its lag, and
  // its derivative must be taken over a step that some jumps lie in.
  const bool jumps = observations.has(simulation::joint_torque);
  for (int joint = 0; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "servo_lag";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"time_constant", "s", 0, 1, jumps ? 0.2 : 0.01}};
    hypothesis.linear = jumps ? 0 : 1;
    hypothesis.starts = jumps ? guesses : std::vector<Values>{{}};
    hypothesis.alters_model = true;
    hypothesis.is_curved = true;
    hypothesis.statement = joint == 0 ? "the joints follow their command late"
                                      : fmt::format("joint {} follows its command late", joint);
    const int first = joint == 0 ? 1 : joint;
    const int last = joint == 0 ? 6 : joint;
    hypothesis.apply = [=](const Values& values, Machine* machine) {
      machine->lag.segment(first - 1, last - first + 1).array() += values[0];
    };
    if (jumps) {
      hypothesis.sketch = [=](const Values& values) { return late_joints(first, last, values[0]); };
    }
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
