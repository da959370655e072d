#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Torque of a drive that is a sinusoid of the joint's angle (cogging, torque ripple of the motor
// seen through the gear; Holtz and Springob 1996).
Forms laws::torque_ripple() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 2;
  law.traits.is_wave = true;
  law.parameters = wave_of_joint("N·m");
  law.words = "ripple of the torque";
  law.statement = says("the torque of joint {} has a periodic part");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
                      add_torque(joint, ripple(at, joint, values), prediction);
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " sine cosine ", [](const Subject& of) { return within(of.effort()); },
            "a joint turns past a ripple that its drive can move"},
           {"", " order ",
            [](const Subject&) {
              return Range{0, 1e4};
            },
            "pole pairs times slots times a gear ratio of some hundred"}}};
}

}  // namespace flexcomp::effects
