#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Term slow_friction(int joint, double excess, double stribeck_speed) {
  return {Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            const Eigen::ArrayXd speed = at.velocity.col(joint - 1).array();
            const Eigen::ArrayXd direction = directions(at, joint);
            add_torque(joint, excess * (-(speed / stribeck_speed).square()).exp() * direction,
                       prediction);
          }};
}

}  // namespace

// Friction that falls with speed at low speed, beyond dry friction: excess exp(-(speed/stribeck
// speed)^2) against the motion (Armstrong-Helouvry, Dupont and Canudas de Wit 1994).
Forms laws::stribeck_friction() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_friction = true;
  law.traits.joins_family = true;
  law.parameters = of_joint({{"excess", "N·m"}, {"speed", "rad/s"}});
  law.words = "friction that falls with speed";
  law.statement = says("the friction of joint {} rises at low speed");
  add_term(
      [](const Values& values, int joint) { return slow_friction(joint, values[0], values[1]); },
      &law);
  return {{law},
          {},
          {{"", " excess ", [](const Subject& of) { return up_to(of.effort()); },
            "a joint starts that its drive can move"},
           {"", " speed ",
            [](const Subject& of) {
              return Range{0, of.velocity()};
            },
            "friction falls within the joint's speeds"}}};
}

}  // namespace flexcomp::effects
