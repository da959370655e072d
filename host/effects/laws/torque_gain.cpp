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
                      alter_shown_torque(
                          joint,
                          [&](Eigen::Ref<Eigen::VectorXd> torque) { torque *= 1 + values[0]; },
                          prediction);
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
  law.statement = says("the torques are measured with a gain that changes as the drives warm",
                       "the torque of joint {} is measured with a gain that changes as it warms");
  law.apply = [](const Values& values, int joint, Machine* machine) {
    const std::optional<double> reference = machine->robot.reference_temperature;
    machine->terms.push_back(
        {Term::instrument, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
           const Eigen::VectorXd gain = 1 + values[0] * warming(scene, reference).array();
           alter_shown_torque(
               joint,
               [&](Eigen::Ref<Eigen::VectorXd> torque) { torque = torque.cwiseProduct(gain); },
               prediction);
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
