#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Dry friction: a torque of constant size against the motion (Armstrong-Helouvry, Dupont and
// Canudas de Wit 1994).
Forms laws::coulomb_friction() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_friction = true;
  law.traits.is_in_family = true;
  law.traits.is_model_number = true;
  law.traits.measures = Measures::friction;
  law.parameters = of_joint({{"torque", "N·m"}});
  law.derived = whole_of("whole_torque", "N·m", &model::JointDynamics::coulomb);
  law.words = "dry friction";
  law.statement = says("joint {} has another dry friction");
  alter_keys([](const Values& values, int joint,
                model::Robot* robot) { robot->dynamics[index_of(joint)].coulomb += values[0]; },
             &law);
  return {{law},
          {},
          {{"", " torque ",
            [](const Subject& of) { return change(of.dynamics().coulomb, of.effort()); },
            "friction does not drive, and a joint moves that its drive can move"}}};
}

}  // namespace flexcomp::effects
