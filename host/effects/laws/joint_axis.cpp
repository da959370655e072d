#include <Eigen/Geometry>
#include <array>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
// A joint's axis is tilted in the link before it: two small rotations of the joint's frame across
// the axis. It is the parameter that Denavit and Hartenberg's lack for axes that are nearly
// parallel (Hayati and Mirmirani 1985), and their twist elsewhere.
Forms laws::joint_axis() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 2;
  law.traits.is_in_family = true;
  law.parameters = [](const model::Robot& robot, int joint) {
    return of_axes(axes_across_joint(robot, joint), "tilt_", "rad");
  };
  law.words = "direction of the axis";
  law.statement = says("the axis of joint {} is tilted");
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        const std::array<int, 2> axes = axes_across_joint(*robot, joint);
        Matrix3<double>& rotation = robot->elastic.joints[index_of(joint)].origin.rotation;
        for (std::size_t i = 0; i < axes.size(); ++i) {
          rotation *=
              Eigen::AngleAxisd(values[i], Vector3<double>::Unit(axes[i])).toRotationMatrix();
        }
      },
      &law);
  return {{law},
          {},
          {{"", " tilt_x tilt_y tilt_z ", [](const Subject&) { return within(0.1, kUsualTilt); },
            "an axis 6° askew is another machine; castings are machined to minutes of arc"}}};
}

}  // namespace flexcomp::effects
