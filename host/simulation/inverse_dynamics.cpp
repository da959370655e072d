#include "simulation/inverse_dynamics.hpp"

#include "model/chain_kinematics.hpp"

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

  /// Acceleration of a point that is fixed to the link, `arm` away from its origin.
  Vector acceleration_at(const Vector& arm) const {
    return acceleration + angular_acceleration.cross(arm) + spin.cross(spin.cross(arm));
  }
};

/// Force and moment that move a link, about its origin.
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

/// How one joint moves: angle or travel and its derivatives.
struct JointMotion {
  double q, velocity, acceleration;
};

void turn(const model::ChainJoint& joint, const JointMotion& by, const Vector& axis,
          Motion* motion) {
  const Vector spin = by.velocity * axis;
  motion->rotation = motion->rotation * axis_rotation<double>(joint.axis, by.q);
  motion->angular_acceleration =
      motion->angular_acceleration + by.acceleration * axis + motion->spin.cross(spin);
  motion->spin += spin;
}

/// On a link that turns, what slides is turned as well (Coriolis).
void slide(const JointMotion& by, const Vector& axis, Motion* motion) {
  const Vector along = by.q * axis;
  motion->acceleration = motion->acceleration_at(along) + by.acceleration * axis +
                         2 * motion->spin.cross(by.velocity * axis);
  motion->origin += along;
}

Motion next(const Motion& before, const model::ChainJoint& joint, const JointMotion& by,
            Vector* axis) {
  Motion motion = before;
  const Vector arm = before.rotation * joint.origin.position;
  motion.origin = before.origin + arm;
  motion.acceleration = before.acceleration_at(arm);
  motion.rotation = before.rotation * joint.origin.rotation;
  *axis = motion.rotation * joint.axis;
  if (joint.slides()) {
    slide(by, *axis, &motion);
  } else {
    turn(joint, by, *axis, &motion);
  }
  return motion;
}

}  // namespace

JointValues inverse_dynamics(const model::Robot& robot, const JointValues& q,
                             const JointValues& velocity, const JointValues& acceleration) {
  const model::Chain& chain = robot.elastic;
  model::PerJoint<Effort> efforts(chain.joints.size());
  Motion motion;
  motion.acceleration = -chain.gravity;
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const model::ChainJoint& joint = chain.joints[i];
    Effort& effort = efforts[i];
    motion = next(motion, joint, {q[at], velocity[at], acceleration[at]}, &effort.axis);
    effort.origin = motion.origin;
    const Vector arm = motion.rotation * joint.center_of_mass;
    effort.add(arm, joint.mass * motion.acceleration_at(arm));
    const auto turned = [&](const Vector& vector) -> Vector {
      return motion.rotation * (robot.link_inertia[i] * (motion.rotation.transpose() * vector));
    };
    effort.moment += turned(motion.angular_acceleration) + motion.spin.cross(turned(motion.spin));
  }
  const Vector payload =
      motion.rotation * (chain.tool.position + chain.tool.rotation * chain.payload_center);
  efforts.back().add(payload, chain.payload_mass * motion.acceleration_at(payload));
  JointValues torque(chain.size());
  for (std::size_t i = efforts.size(); i-- > 0;) {
    const Effort& effort = efforts[i];
    torque[static_cast<Eigen::Index>(i)] =
        joint_load(chain.joints[i], effort.axis, effort.force, effort.moment);
    if (i > 0) {
      efforts[i - 1].moment += effort.moment;
      efforts[i - 1].add(effort.origin - efforts[i - 1].origin, effort.force);
    }
  }
  return torque;
}

}  // namespace flexcomp::simulation
