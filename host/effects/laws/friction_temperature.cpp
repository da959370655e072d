#include "effects/laws/laws.hpp"
#include "effects/temperature.hpp"

namespace flexcomp::effects {
namespace {

/// Friction of the motors at the reference temperature, at every row (n×joints, N·m on the motors).
Eigen::MatrixXd friction_at_reference(const model::Robot& robot, const Eigen::MatrixXd& motor_speed,
                                      bool has_dry) {
  Eigen::MatrixXd friction = motor_speed;
  for (Eigen::Index motor = 0; motor < friction.cols(); ++motor) {
    const model::JointDynamics& dynamics = robot.dynamics[static_cast<std::size_t>(motor)];
    for (double& value : friction.col(motor)) {
      value = dynamics.viscous * value +
              (has_dry ? dynamics.coulomb * simulation::direction_of_motion(value) : 0);
    }
  }
  return friction;
}

Law friction_by_temperature(const char* form, bool has_dry, const char* of_all,
                            const char* of_one) {
  Law law;
  law.form = form;
  law.joints = machine_or_joint;
  law.traits.linear_in = 1;
  law.traits.is_curved = true;
  law.traits.is_friction = true;
  law.traits.needs_temperature = true;
  law.parameters = constant({{"rate", "1/K"}});
  law.statement = says(of_all, of_one);
  law.apply = [has_dry](const Values& values, int joint, Machine* machine) {
    machine->terms.push_back(
        {Term::output, [=, robot = machine->robot](const Scene& scene, const Simulation& at,
                                                   Prediction* prediction) {
           Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
           if (torque.cols() == 0) {
             return;
           }
           Eigen::MatrixXd friction =
               friction_at_reference(robot, at.velocity * robot.transmission.transpose(), has_dry);
           if (joint > 0) {
             const Eigen::VectorXd alone = friction.col(joint - 1);
             friction.setZero();
             friction.col(joint - 1) = alone;
           }
           const Eigen::VectorXd growth =
               (values[0] * warming(scene, robot.reference_temperature)).array().exp() - 1;
           torque += growth.asDiagonal() * friction * robot.transmission;
         }});
  };
  return law;
}

}  // namespace

// Friction that changes with the temperature of the gears, by the same share a kelvin: that of
// grease falls as it warms (Bittencourt and Axehill 2012, "Static friction in a robot joint").
// Forms: the viscous part alone, or the dry one as well.
Forms laws::friction_temperature() {
  return {{friction_by_temperature("", true, "the friction of the joints changes as they warm",
                                   "the friction of joint {} changes as it warms"),
           friction_by_temperature("viscous", false,
                                   "the viscous friction of the joints changes as they warm",
                                   "the viscous friction of joint {} changes as it warms")},
          {},
          {{"", " rate ", [](const Subject&) { return within(0.2); },
            "greases halve their viscosity in 10 to 20 K: none changes by a fifth in one"}}};
}

}  // namespace flexcomp::effects
