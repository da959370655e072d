#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Zero of the force sensor, in the tool frame: it reads the wrench plus the bias.
Forms laws::wrench_bias() {
  Law law;
  law.joints = {0};
  law.traits.linear_in = 6;
  law.parameters = constant(
      {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}, {"mx", "N·m"}, {"my", "N·m"}, {"mz", "N·m"}});
  law.statement = says("the force sensor has another zero");
  alter_sensor(
      [](const Values& values, const Wrench<double>& read) {
        return Wrench<double>(read - Eigen::Map<const Wrench<double>>(values.data()));
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
