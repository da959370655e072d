#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Inertia of motor and gear, reflected to the joint: torque in proportion to the joint's
// acceleration (rigid-body dynamics).
Forms laws::rotor_inertia() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.tells_inertia = true;
  law.traits.is_in_family = true;
  law.parameters = of_joint({{"inertia", "kg·m^2"}});
  law.derived = whole_of("whole_inertia", "kg·m^2", &model::JointDynamics::rotor_inertia);
  law.statement = says("the rotor of joint {} has another inertia");
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        robot->dynamics[index_of(joint)].rotor_inertia += values[0];
      },
      &law);
  return {{law},
          {},
          {{"", " inertia ",
            [](const Subject& of) { return change(of.dynamics().rotor_inertia, of.effort()); },
            "a drive whose largest torque moves its own rotor by 1 rad/s² moves no arm"}}};
}

}  // namespace flexcomp::effects
