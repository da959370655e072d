#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// The foundation or pedestal gives: a diagonal spring at the base frame (Klimchik et al. 2017).
Forms laws::base_compliance() {
  Law law;
  law.joints = {0};
  law.traits.linear_in = 6;
  law.parameters = constant({{"x", "m/N"},
                             {"y", "m/N"},
                             {"z", "m/N"},
                             {"rx", "rad/(N·m)"},
                             {"ry", "rad/(N·m)"},
                             {"rz", "rad/(N·m)"}});
  law.statement = says("the base gives");
  alter_keys(
      [](const Values& values, int, model::Robot* robot) {
        robot->elastic.base_compliance += Eigen::Map<const Twist<double>>(values.data());
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
