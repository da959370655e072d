#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Spindle, holder or flange give: a diagonal spring at the tool frame (Klimchik et al. 2017). Its
// rotations do not move the TCP.
Forms laws::tool_compliance() {
  Law law;
  law.joints = {0};
  law.traits.linear_in = 3;
  law.parameters = constant({{"x", "m/N"}, {"y", "m/N"}, {"z", "m/N"}});
  law.statement = says("spindle, holder or flange give");
  alter_keys(
      [](const Values& values, int, model::Robot* robot) {
        robot->elastic.tool_compliance.head<3>() +=
            Eigen::Map<const Vector3<double>>(values.data());
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
