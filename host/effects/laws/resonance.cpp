#include <cmath>
#include <functional>
#include <limits>

#include "effects/inertia.hpp"
#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

/// Natural frequencies (Hz) of a mode at the rows of a scene.
using Frequencies = std::function<Eigen::VectorXd(const Scene&)>;

Frequencies everywhere(double frequency) {
  return [=](const Scene& scene) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(scene.rows(), frequency);
  };
}

Eigen::VectorXd frequency_of(double stiffness, const Eigen::VectorXd& inertia) {
  return (stiffness / inertia.array()).sqrt() / (2 * M_PI);
}

Term vibration(int joint, const Frequencies& frequencies, double damping) {
  return {Term::load, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            if (scene.is_static) {
              return;
            }
            const double compliance = at.joint_compliance[joint - 1];
            const Eigen::VectorXd frequency = frequencies(scene);
            const auto beyond_static = [&](const Eigen::VectorXd& load) {
              return Eigen::VectorXd(simulation::mode(scene.time, load, frequency, damping) - load);
            };
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& load) {
                  return Eigen::VectorXd(compliance * beyond_static(load));
                },
                prediction);
            if (prediction->channel[simulation::joint_torque].cols() > 0) {
              add_torque(joint, -beyond_static(prediction->dynamic_load.col(joint - 1)),
                         prediction);
            }
          }};
}

}  // namespace

// A lightly damped mode of a joint's spring and what it carries: wind-up follows its load as a
// second-order system does, and the drive feels the vibrating torque (Spong 1987). Its frequency is
// constant, or (form `posture`) that of a spring with the inertia that the joint carries in each
// posture.
Forms laws::resonance() {
  Law constant_mode;
  constant_mode.joints = every_joint;
  constant_mode.traits.can_be_undone = false;
  Law by_posture = constant_mode;
  constant_mode.parameters = constant({{"frequency", "Hz"}, {"damping", "1"}});
  constant_mode.words = "vibration";
  constant_mode.statement = says("joint {} vibrates in a lightly damped mode");
  add_term([](const Values& values,
              int joint) { return vibration(joint, everywhere(values[0]), values[1]); },
           &constant_mode);
  by_posture.form = "posture";
  by_posture.parameters = of_joint({{"stiffness", "N·m/rad"}, {"damping", "1"}});
  by_posture.impossible = [](const model::Robot& robot, int joint) {
    const double inertia =
        carried_inertia(robot, simulation::JointValues::Zero(robot.joints()), joint);
    return inertia > 0 ? "" : "what it carries has no inertia";
  };
  by_posture.statement =
      says("joint {} vibrates in a lightly damped mode, slower the more inertia it carries");
  by_posture.apply = [](const Values& values, int joint, Machine* machine) {
    const model::Robot robot = machine->robot;
    const Frequencies frequencies = [=](const Scene& scene) {
      return frequency_of(values[0], carried_inertia(robot, scene, joint));
    };
    machine->terms.push_back(vibration(joint, frequencies, values[1]));
  };
  return {{constant_mode, by_posture},
          {},
          {{"", " frequency ",
            [](const Subject&) {
              return Range{1, 300};
            },
            "arms' lowest modes are at 2 to 60 Hz (Abele, Weigold and Rothenbuecher 2007)"},
           {"", " stiffness ",
            [](const Subject&) {
              return Range{0, std::numeric_limits<double>::infinity()};
            },
            "a spring pulls back; its size follows from the frequencies above"},
           {"", " damping ",
            [](const Subject&) {
              return Range{0, 0.5};
            },
            "steel and gears damp by 0.002 to 0.2; beyond 0.5 nothing swings"}}};
}

}  // namespace flexcomp::effects
