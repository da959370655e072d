#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Gain of a drive's torque: torque constant, gear ratio or current sensor, which scale all that is
// measured of a joint (Gautier and Briot 2014, "Global identification of joint drive gains").
Forms laws::torque_gain() {
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
  return {{law},
          {},
          {{"", " gain ",
            [](const Subject&) {
              constexpr double kUsual = 0.1;
              return Range{-0.5, 1, Rest::nowhere, "", kUsual};
            },
            "torque constants vary by a tenth (Gautier and Briot 2014); none is off twofold"}}};
}

}  // namespace flexcomp::effects
