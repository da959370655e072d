#include <cmath>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Mass on the flange that differs from the model's, as a point: mass and first moment in the tool
// frame (rigid-body dynamics).
Forms laws::payload() {
  Law law;
  law.joints = {0};
  law.traits.linear_in = 4;
  law.traits.is_body = true;
  law.parameters = constant({{"mass", "kg"}, {"mx", "kg·m"}, {"my", "kg·m"}, {"mz", "kg·m"}});
  law.statement = says("the mass on the flange is another");
  alter_keys(
      [](const Values& values, int, model::Robot* whole) {
        RobotModel<double, 6>& robot = whole->elastic;
        const Vector3<double> moment = robot.payload_mass * robot.payload_center +
                                       Vector3<double>(values[1], values[2], values[3]);
        robot.payload_mass += values[0];
        robot.payload_center = std::abs(robot.payload_mass) > 1e-3
                                   ? Vector3<double>(moment / robot.payload_mass)
                                   : Vector3<double>::Zero();
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
