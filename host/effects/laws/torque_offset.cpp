#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Constant torque, or the zero of a current sensor.
Forms laws::torque_offset() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_in_family = true;
  law.parameters = of_joint({{"torque", "N·m"}});
  law.words = "zero of the torque";
  law.statement = says("the torque of joint {} has another zero");
  add_term(
      [](const Values& values, int joint) {
        return Term{
            Term::output, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
              add_torque(joint, Eigen::VectorXd::Constant(scene.rows(), values[0]), prediction);
            }};
      },
      &law);
  return {{law},
          {},
          {{"", " torque ", [](const Subject& of) { return within(of.effort()); },
            "a current sensor's zero lies within what it is made to measure"}}};
}

}  // namespace flexcomp::effects
