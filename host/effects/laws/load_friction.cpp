#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Term friction_under_load(int joint, double coefficient) {
  return {Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            if (prediction->dynamic_load.cols() == 0) {
              return;
            }
            const Eigen::ArrayXd direction = directions(at, joint);
            add_torque(
                joint,
                coefficient * direction * prediction->dynamic_load.col(joint - 1).array().abs(),
                prediction);
          }};
}

}  // namespace

// Dry friction that grows with the load on the gear, as its losses do: a share of the torque on the
// joint, against the motion (Hamon, Gautier and Garrec 2010, "Dynamic identification of robots with
// a dry friction model depending on load and velocity").
Forms laws::load_friction() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_friction = true;
  law.traits.is_in_family = true;
  law.parameters = constant({{"coefficient", "1"}});
  law.statement = says("the dry friction of joint {} grows with the load");
  add_term([](const Values& values, int joint) { return friction_under_load(joint, values[0]); },
           &law);
  return {{law},
          {},
          {{"", " coefficient ", [](const Subject&) { return up_to(0.5); },
            "no gear loses more than half of the torque that it carries"}}};
}

}  // namespace flexcomp::effects
