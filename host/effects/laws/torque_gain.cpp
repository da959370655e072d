#include "effects/laws/laws.hpp"
#include "effects/temperature.hpp"

namespace flexcomp::effects {
namespace {

Law constant_gain() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_in_family = true;
  law.traits.is_gain = true;
  law.traits.can_be_undone = false;
  law.parameters = constant({{"gain", "1"}});
  law.statement = says("the torque of joint {} is measured with another gain");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::instrument, [=](const Scene&, const Simulation&, Prediction* prediction) {
                      Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
                      if (torque.cols() > 0) {
                        torque.col(joint - 1) *= 1 + values[0];
                      }
                    }};
      },
      &law);
  return law;
}

/// Of one joint, or of all alike.
Law by_temperature_gain() {
  Law law;
  law.form = "temperature";
  law.joints = machine_or_joint;
  law.traits.linear_in = 1;
  law.traits.can_be_undone = false;
  law.traits.needs_temperature = true;
  law.parameters = constant({{"rate", "1/K"}});
  law.statement = [](int joint) -> std::string {
    return joint == 0
               ? "the torques are measured with a gain that changes as the drives warm"
               : fmt::format(
                     "the torque of joint {} is measured with a gain that changes as it warms",
                     joint);
  };
  law.apply = [](const Values& values, int joint, Machine* machine) {
    const std::optional<double> reference = machine->robot.reference_temperature;
    machine->terms.push_back(
        {Term::instrument, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
           Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
           const Eigen::VectorXd gain = 1 + values[0] * warming(scene, reference).array();
           for (Eigen::Index i = 0; i < torque.cols(); ++i) {
             if (joint == 0 || joint == i + 1) {
               torque.col(i) = torque.col(i).cwiseProduct(gain);
             }
           }
         }});
  };
  return law;
}

}  // namespace

// Gain of a drive's torque: torque constant, gear ratio or current sensor, which scale all that is
// measured of a joint (Gautier and Briot 2014, "Global identification of joint drive gains"). Form
// by temperature: a motor's magnets weaken as they warm, so that it takes more current for the same
// torque.
Forms laws::torque_gain() {
  return {{constant_gain(), by_temperature_gain()},
          {},
          {{"", " gain ",
            [](const Subject&) {
              constexpr double kUsual = 0.1;
              return Range{-0.5, 1, Rest::nowhere, "", kUsual};
            },
            "torque constants vary by a tenth (Gautier and Briot 2014); none is off twofold"},
           {"temperature", " rate ", [](const Subject&) { return within(0.02); },
            "magnets lose 0.1 to 0.2 % a kelvin, and sensors' amplifiers less"}}};
}

}  // namespace flexcomp::effects
