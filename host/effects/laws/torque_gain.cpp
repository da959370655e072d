#include <cmath>

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

/// The heat of a drive, in squares of its torque (N·m)², which follows these with a lag of the
/// first order (s). When the recording begins, it has long been what it is then.
Eigen::VectorXd heat(const Eigen::VectorXd& time, const Eigen::VectorXd& torque, double constant) {
  Eigen::VectorXd heat = torque.cwiseAbs2();
  for (Eigen::Index row = 1; row < heat.size(); ++row) {
    const double kept = std::exp(-(time[row] - time[row - 1]) / constant);
    heat[row] += (heat[row - 1] - heat[row]) * kept;
  }
  return heat;
}

Law by_heat_gain() {
  Law law;
  law.form = "heat";
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.can_be_undone = false;
  law.parameters = constant({{"heat_gain", "1/(N·m)^2"}, {"time_constant", "s"}});
  law.statement =
      says("the torque of joint {} is measured with a gain that changes as its drive warms");
  add_term(
      [](const Values& values, int joint) {
        return Term{
            Term::instrument, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
              if (!scene.is_static) {
                alter_shown_torque(
                    joint,
                    [&](Eigen::Ref<Eigen::VectorXd> torque) {
                      torque.array() *= 1 + values[0] * heat(scene.time, torque, values[1]).array();
                    },
                    prediction);
              }
            }};
      },
      &law);
  return law;
}

}  // namespace

// Gain of a drive's torque: torque constant, gear ratio or current sensor, which scale all that is
// measured of a joint (Gautier and Briot 2014, "Global identification of joint drive gains"). Form
// by temperature: a motor's magnets weaken as they warm, so that it takes more current for the same
// torque. Form by heat: nobody recorded the temperature, and the drive warms by its copper's
// losses, which go with the square of its torque.
Forms laws::torque_gain() {
  return {{constant_gain(), by_temperature_gain(), by_heat_gain()},
          {},
          {{"", " gain ",
            [](const Subject&) {
              constexpr double kUsual = 0.1;
              return Range{-0.5, 1, Rest::nowhere, "", kUsual};
            },
            "torque constants vary by a tenth (Gautier and Briot 2014); none is off twofold"},
           {"temperature", " rate ", [](const Subject&) { return within(0.02); },
            "magnets lose 0.1 to 0.2 % a kelvin, and sensors' amplifiers less"},
           {"heat", " heat_gain ",
            [](const Subject& of) {
              constexpr double kMost =
                  1;  // of the largest torque, held for long: twice what drives hold
              return within(over(kMost, of.load() * of.load()));
            },
            "magnets lose 0.1 to 0.2 % a kelvin, and motors' windings bear 155 °C (IEC 60085, "
            "class F)"},
           {"heat", " time_constant ",
            [](const Subject&) {
              constexpr double kQuickest = 1;
              return Range{kQuickest, 1e5, Rest::nowhere};
            },
            "windings of small motors warm in seconds, whole motors in an hour (motors' data "
            "sheets)"}}};
}

}  // namespace flexcomp::effects
