#include "simulation/inverse_dynamics.hpp"

#include "flexcomp/chain.hpp"

namespace flexcomp::simulation {
namespace {

using Vector = Vector3<double>;
using Matrix = Matrix3<double>;

/// A link on its way; all in the base frame.
struct Motion {
  Matrix rotation = Matrix::Identity();
  Vector origin = Vector::Zero();
  Vector spin = Vector::Zero();                  ///< rad/s
  Vector angular_acceleration = Vector::Zero();  ///< rad/s²
  Vector acceleration = Vector::Zero();          ///< of the origin, less gravity, m/s²

  /// Of a point that is fixed to the link, `arm` away from its origin.
  Vector acceleration_at(const Vector& arm) const {
    return acceleration + angular_acceleration.cross(arm) + spin.cross(spin.cross(arm));
  }
};

/// What moves a link, about its origin.
struct Effort {
  Vector axis;
  Vector origin;
  Vector force = Vector::Zero();
  Vector moment = Vector::Zero();

  void add(const Vector& arm, const Vector& more) {
    force += more;
    moment += arm.cross(more);
  }
};

Motion next(const Motion& before, const Joint<double>& joint, double q, double velocity,
            double acceleration, Vector* axis) {
  Motion motion;
  const Vector arm = before.rotation * joint.origin.position;
  const Matrix rotation = before.rotation * joint.origin.rotation;
  *axis = rotation * joint.axis;
  motion.rotation = rotation * axis_rotation<double>(joint.axis, q);
  motion.origin = before.origin + arm;
  motion.spin = before.spin + velocity * *axis;
  motion.angular_acceleration =
      before.angular_acceleration + acceleration * *axis + before.spin.cross(velocity * *axis);
  motion.acceleration = before.acceleration_at(arm);
  return motion;
}

}  // namespace

JointVector<double, 6> inverse_dynamics(const model::Robot& robot, const JointVector<double, 6>& q,
                                        const JointVector<double, 6>& velocity,
                                        const JointVector<double, 6>& acceleration) {
  const RobotModel<double, 6>& elastic = robot.elastic;
  std::array<Effort, 6> efforts;
  Motion motion;
  motion.acceleration = -elastic.gravity;
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Joint<double>& joint = elastic.joints[i];
    Effort& effort = efforts[i];
    motion = next(motion, joint, q[at], velocity[at], acceleration[at], &effort.axis);
    effort.origin = motion.origin;
    const Vector arm = motion.rotation * joint.center_of_mass;
    effort.add(arm, joint.mass * motion.acceleration_at(arm));
    const auto turned = [&](const Vector& vector) -> Vector {
      return motion.rotation * (robot.link_inertia[i] * (motion.rotation.transpose() * vector));
    };
    effort.moment += turned(motion.angular_acceleration) + motion.spin.cross(turned(motion.spin));
  }
  const Vector payload =
      motion.rotation * (elastic.tool.position + elastic.tool.rotation * elastic.payload_center);
  efforts.back().add(payload, elastic.payload_mass * motion.acceleration_at(payload));
  JointVector<double, 6> torque;
  for (std::size_t i = efforts.size(); i-- > 0;) {
    const Effort& effort = efforts[i];
    torque[static_cast<Eigen::Index>(i)] = effort.axis.dot(effort.moment);
    if (i > 0) {
      efforts[i - 1].moment += effort.moment;
      efforts[i - 1].add(effort.origin - efforts[i - 1].origin, effort.force);
    }
  }
  return torque;
}

}  // namespace flexcomp::simulation
