#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Cubic torque-deflection curve of a joint, deflection = c1 tau + c3 tau^3, softening above zero
// and hardening below (strain-wave and cycloidal gears; Albu-Schaeffer 2002).
Forms laws::nonlinear_stiffness() {
  Law law;
  law.joints = joints(1, 6);
  law.traits.linear_in = 1;
  law.parameters = constant({{"cubic_compliance", "rad/(N·m)^3"}});
  law.statement = says("joint {} winds up out of proportion to its torque");
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        robot->elastic.joints[index_of(joint)].cubic_compliance += values[0];
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
