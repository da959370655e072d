#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Range half_of_length(const Subject& of) {
  const auto& joints = of.robot.elastic.joints;
  const double length = joints[std::min(of.index() + 1, joints.size() - 1)].origin.position.norm();
  return within(std::max(0.5 * length, 0.02 * of.size.reach), kUsualShift * of.size.reach);
}

}  // namespace

// Length of the link that a joint moves, along the line to the next joint (kinematic calibration;
// Mooring, Roth and Driels 1991).
Forms laws::link_length() {
  Law law;
  law.joints = all_but_the_last;
  law.traits.linear_in = 1;
  law.traits.is_in_family = true;
  law.parameters = constant({{"length", "m"}});
  law.impossible = [](const model::Robot& robot, int joint) {
    constexpr double kNothing = 1e-6;  // m
    const Vector3<double>& along = robot.elastic.joints[index_of(joint) + 1].origin.position;
    return along.norm() < kNothing ? "its link has no length" : "";
  };
  law.words = "length of the link";
  law.statement = says("the link that joint {} moves has another length");
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        Vector3<double>& next = robot->elastic.joints[index_of(joint) + 1].origin.position;
        next += values[0] * next.normalized();
      },
      &law);
  return {{law},
          {},
          {{"", " length ", half_of_length,
            "with half of its length more or less a link is that of another robot"}}};
}

}  // namespace flexcomp::effects
