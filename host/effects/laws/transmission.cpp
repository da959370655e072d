#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// A motor that turns with the joint before its own as well, by so many turns of its own joint a
// turn of that one: a coupled wrist, whose last motors sit in the forearm (Siciliano et al. 2009,
// Robotics, section 7.2: friction and rotors act by the motors' speeds).
Forms laws::transmission() {
  Law law;
  law.joints = all_but_the_first;
  law.traits.is_curved = true;
  law.traits.couples_drives = true;
  law.parameters = constant({{"ratio", "1"}});
  law.words = "coupling of the drives";
  law.statement = says("the motor of joint {} turns with the joint before it as well");
  alter_keys([](const Values& values, int joint,
                model::Robot* robot) { robot->transmission(joint - 1, joint - 2) += values[0]; },
             &law);
  return {{law},
          {},
          {{"", " ratio ", [](const Subject&) { return within(3); },
            "wrists are coupled one to one, or by the quotient of two gear ratios"}}};
}

}  // namespace flexcomp::effects
