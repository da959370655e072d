#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Zero of a joint's encoder: the joint stands at its reading plus the offset (Denavit-Hartenberg
// angle error; Mooring, Roth and Driels 1991).
Forms laws::joint_offset() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_in_family = true;
  law.traits.alters_model = true;
  law.traits.measures = Measures::zero;
  law.parameters = of_joint({{"offset", "rad"}});
  law.words = "encoder zero";
  law.statement = says("the encoder of joint {} has another zero");
  law.apply = [](const Values& values, int joint, Machine* machine) {
    machine->encoder_offset[joint - 1] += values[0];
  };
  return {{law},
          {},
          {{"", " offset ",
            [](const Subject& of) {
              return of.joint().slides()
                         ? within(of.joint().upper - of.joint().lower, kUsualShift * of.size.reach)
                         : within(M_PI, 2 * kUsualTilt);
            },
            "an encoder may be set to zero anywhere"}}};
}

}  // namespace flexcomp::effects
