#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

/// First and last of the joints that lag; joint 0: all of them.
int first_of(int joint) { return joint == 0 ? 1 : joint; }
int last_of(int joint, Eigen::Index joints) {
  return joint == 0 ? static_cast<int>(joints) : joint;
}

/// To begin with, a joint's torque comes so much later, and its angle by the lag itself.
Term late_joints(const Values& values, int which) {
  return {Term::output, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            const double constant = values[0];
            Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
            for (int joint = first_of(which);
                 joint <= last_of(which, scene.joints()) && !scene.is_static; ++joint) {
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
// (Siciliano et al. 2009, section 8).
Forms laws::servo_lag() {
  Law law;
  law.joints = machine_or_joint;
  law.traits.linear_in = 1;
  law.traits.alters_model = true;
  law.traits.is_curved = true;
  law.parameters = constant({{"time_constant", "s"}});
  law.statement = says("the joints follow their command late", "joint {} follows its command late");
  law.apply = [](const Values& values, int joint, Machine* machine) {
    const int count = last_of(joint, machine->lag.size()) - first_of(joint) + 1;
    machine->lag.segment(first_of(joint) - 1, count).array() += values[0];
  };
  law.sketch = late_joints;
  return {{law},
          {},
          {{"", " time_constant ", [](const Subject&) { return up_to(1); },
            "position loops close at 1 to 20 Hz; none is slower than a second"}}};
}

}  // namespace flexcomp::effects
