#include <Eigen/Geometry>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// The robot stands less level than the model says, on its floor, column or frame: gravity has
// another direction in the base frame. Where positions were measured it shows as other deflections
// alone, since the instrument's frame turns with whatever it was aligned to.
Forms laws::gravity_tilt() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 2;
  law.traits.is_in_family = true;
  law.parameters = [](const model::Robot& robot, int /*joint*/) {
    return of_axes(axes_across(robot.elastic.gravity), "r", "rad");
  };
  law.words = "level";
  law.statement = says("the robot does not stand level");
  alter_keys(
      [](const Values& values, int /*joint*/, model::Robot* robot) {
        Vector3<double> turn = Vector3<double>::Zero();
        const std::array<int, 2> axes = axes_across(robot->elastic.gravity);
        for (std::size_t i = 0; i < axes.size(); ++i) {
          turn[axes[i]] = values[i];
        }
        const Eigen::AngleAxisd rotation(turn.norm(), turn.stableNormalized());
        robot->elastic.gravity = rotation * robot->elastic.gravity;
      },
      &law);
  return {{law},
          {},
          {{"", " rx ry rz ", [](const Subject&) { return within(0.2, kUsualTilt); },
            "robots are levelled to some mm per m; one that leans by 10° is mounted otherwise"}}};
}

}  // namespace flexcomp::effects
