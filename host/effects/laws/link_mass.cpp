#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

/// Adds a point mass at the link's origin and a first moment (kg·m), which has no inertia of its
/// own.
void mount(double mass, const Vector3<double>& moment, std::size_t index, model::Robot* robot) {
  Joint<double>& link = robot->elastic.joints[index];
  const auto about_origin = [](double m, const Vector3<double>& c) {
    return Matrix3<double>(m * (c.squaredNorm() * Matrix3<double>::Identity() - c * c.transpose()));
  };
  const Matrix3<double> inertia =
      robot->link_inertia[index] + about_origin(link.mass, link.center_of_mass);
  const Vector3<double> total = link.mass * link.center_of_mass + moment;
  link.mass = std::max(link.mass + mass, 1e-3);
  link.center_of_mass = total / link.mass;
  robot->link_inertia[index] = inertia - about_origin(link.mass, link.center_of_mass);
}

}  // namespace

// Mass of a link that differs from the model's: the same body heavier or lighter in all its parts,
// or mass and first moment (link frame) of something mounted on it (rigid-body dynamics).
Forms laws::link_mass() {
  Law body;
  body.form = "body";
  body.joints = joints(1, 6);
  body.traits.linear_in = 1;
  body.traits.is_body = true;
  body.statement = says("the link that joint {} moves has another mass");
  Law mounted = body;
  body.parameters = constant({{"mass", "kg"}});
  body.impossible = [](const model::Robot& robot, int joint) {
    return robot.elastic.joints[index_of(joint)].mass > 0 ? "" : "its link has no mass";
  };
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        Joint<double>& link = robot->elastic.joints[index_of(joint)];
        robot->link_inertia[index_of(joint)] *= 1 + values[0] / link.mass;
        link.mass += values[0];
      },
      &body);
  mounted.form = "mounted";
  mounted.traits.linear_in = 4;
  mounted.parameters = constant({{"mass", "kg"}, {"mx", "kg·m"}, {"my", "kg·m"}, {"mz", "kg·m"}});
  alter_robot(
      [](const Values& values, int joint, model::Robot* robot) {
        mount(values[0], {values[1], values[2], values[3]}, index_of(joint), robot);
      },
      &mounted);
  return {{body, mounted}, {}};
}

}  // namespace flexcomp::effects
