#include <algorithm>

#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

Term load_play(int joint, double gap, double hold) {
  return {Term::load, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& torque) {
                  return Eigen::VectorXd(0.5 * gap * simulation::flank(torque, hold));
                },
                prediction);
          }};
}

Term motion_play(int joint, double gap) {
  return {Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::VectorXd motor = at.q.col(joint - 1);
            add_joint_angle(at, joint, simulation::play(motor, 0.5 * gap) - motor, prediction);
          }};
}

/// Play whose gap alone is known, from the key `backlash`: driven by the load, with a drag of a
/// hundredth of it, where the joint carries any; else by the motion.
Term keyed_play(int joint, double gap) {
  constexpr double kDrag = 0.01;  // of the load
  return {Term::load, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            const auto largest = [&](const Eigen::MatrixXd& load) {
              return load.cols() > 0 ? load.col(joint - 1).cwiseAbs().maxCoeff() : 0.0;
            };
            const double load =
                std::max(largest(prediction->load), largest(prediction->dynamic_load));
            if (load > kLeastFlankLoad) {
              load_play(joint, gap, kDrag * load).add(scene, at, prediction);
            } else if (!scene.is_static) {
              motion_play(joint, gap).add(scene, at, prediction);
            }
          }};
}

void add_key(const Values& values, int joint, model::Robot* robot) {
  robot->dynamics[index_of(joint)].backlash += values[0];
}

}  // namespace

// Play between motor and link. Under load the torque decides on which flank the link rests, and the
// drag `hold` keeps it there until the torque has reversed (Nordin and Gutman 2002). Without load
// the motor drags the link along behind it: the play operator along the motion (Visintin 1994).
Forms laws::backlash() {
  Law by_load;
  by_load.form = "load";
  by_load.joints = every_joint;
  by_load.traits.linear_in = 1;
  by_load.parameters = of_joint({{"gap", "rad"}, {"hold", "N·m"}});
  by_load.words = "play";
  by_load.statement = says("joint {} has play");
  by_load.write_keys = add_key;
  Law by_motion = by_load;
  add_term([](const Values& values, int joint) { return load_play(joint, values[0], values[1]); },
           &by_load);
  by_motion.form = "motion";
  by_motion.parameters = of_joint({{"gap", "rad"}});
  add_term([](const Values& values, int joint) { return motion_play(joint, values[0]); },
           &by_motion);
  const auto apply_keys = [](const model::Robot& robot, int joint, Machine* machine) {
    const double gap = robot.dynamics[index_of(joint)].backlash;
    if (gap > 0) {
      machine->terms.push_back(keyed_play(joint, gap));
    }
  };
  return {
      {by_load, by_motion},
      apply_keys,
      {{"", " gap ", [](const Subject&) { return up_to(0.01); },
        "gears' data sheets: 1 arcmin (cycloidal) to 20 arcmin (spur gears of servos), and wear"},
       {"", " hold ", [](const Subject& of) { return up_to(of.effort()); },
        "a drag beyond the drive's largest torque would hold the joint"}}};
}

}  // namespace flexcomp::effects
