#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Position error of a gear, a sinusoid of the joint's angle (eccentricity, tooth pitch; Sweet and
// Good 1985 for robots' gears).
Forms laws::transmission_ripple() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 2;
  law.traits.is_wave = true;
  law.parameters = wave_of_joint("rad");
  law.words = "ripple of the gear";
  law.statement = says("the gear of joint {} has a periodic error");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
                      add_joint_angle(at, joint, ripple(at, joint, values), prediction);
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " sine cosine ", [](const Subject&) { return within(0.01); },
            "gears' data sheets: transmission errors of 0.3 to 5 arcmin; 10 mrad are 34"},
           {"", " order ",
            [](const Subject&) {
              return Range{0, 1e4};
            },
            "teeth times a gear ratio of some hundred"}}};
}

}  // namespace flexcomp::effects
