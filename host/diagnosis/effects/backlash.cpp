#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

simulation::Term load_play(int joint, double gap, double hold) {
  return {simulation::Term::load, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& torque) {
                  return Eigen::VectorXd(0.5 * gap * simulation::flank(torque, hold));
                },
                prediction);
          }};
}

simulation::Term motion_play(int joint, double gap) {
  return {simulation::Term::output,
          [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::VectorXd motor = at.q.col(joint - 1);
            add_joint_angle(at, joint, simulation::play(motor, 0.5 * gap) - motor, prediction);
          }};
}

}  // namespace

// Play between motor and link. Under load the torque decides on which flank the link rests, and the
// drag `hold` keeps it there until the torque has reversed (Nordin and Gutman 2002); without load
// the motor drags the link along behind it: the play operator along the motion. Needs the TCP or
// link encoders, and reversals of load or motion.
std::vector<Hypothesis> backlash(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!sees_angles(observations)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "backlash";
    hypothesis.joint = joint;
    hypothesis.linear = 1;
    hypothesis.statement = fmt::format("joint {} has play", joint);
    const double load = observations.largest_load(joint);
    if (load > 1) {
      hypothesis.form = "load";
      hypothesis.parameters = {{"gap", "rad", 0, 0.05, 1e-4},
                               {"hold", "N·m", 1e-3 * load, 0.3 * load, 1e-3 * load}};
      hypothesis.starts.clear();
      for (const double share : {0.003, 0.01, 0.015, 0.02, 0.03, 0.04, 0.07, 0.12}) {
        hypothesis.starts.push_back({share * load});
      }
      hypothesis.apply = [joint](const Values& values, Machine* machine) {
        machine->terms.push_back(load_play(joint, values[0], values[1]));
      };
      all.push_back(hypothesis);
    }
    if (!observations.is_static) {
      hypothesis.form = "motion";
      hypothesis.parameters = {{"gap", "rad", 0, 0.05, 1e-4}};
      hypothesis.starts = {{}};
      hypothesis.apply = [joint](const Values& values, Machine* machine) {
        machine->terms.push_back(motion_play(joint, values[0]));
      };
      all.push_back(hypothesis);
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
