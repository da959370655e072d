#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kNoLength = 1e-6;  // m

/// Axes of the link's frame along which the next joint may stand elsewhere: across the line to it,
/// or across its axis where both joints meet in a point.
std::array<int, 2> offset_axes(const model::Robot& robot, int joint) {
  const model::ChainJoint& next = robot.elastic.joints[index_of(joint) + 1];
  const bool has_length = next.origin.position.norm() > kNoLength;
  return axes_across(has_length ? next.origin.position : next.origin.rotation * next.axis);
}

}  // namespace

// The next joint stands beside where the model has it, across the link that a joint moves: with the
// link's length and the tilts of the axes all six numbers of a frame (Mooring, Roth and Driels
// 1991).
Forms laws::link_offset() {
  Law law;
  law.joints = all_but_the_last;
  law.traits.linear_in = 2;
  law.traits.is_in_family = true;
  law.parameters = [](const model::Robot& robot, int joint) {
    return of_axes(offset_axes(robot, joint), "", "m");
  };
  law.statement = says("the joint after joint {} stands beside its place on the link");
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        const std::array<int, 2> axes = offset_axes(*robot, joint);
        Vector3<double>& next = robot->elastic.joints[index_of(joint) + 1].origin.position;
        const Vector3<double> shift =
            values[0] * Vector3<double>::Unit(axes[0]) + values[1] * Vector3<double>::Unit(axes[1]);
        next += shift;
      },
      &law);
  return {{law},
          {},
          {{"", " x y z ",
            [](const Subject& of) {
              return within(kShiftOfReach * of.size.reach, kUsualShift * of.size.reach);
            },
            "an axis beside its place by a twentieth of the reach is that of another robot"}}};
}

}  // namespace flexcomp::effects
