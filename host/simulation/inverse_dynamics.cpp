#include "simulation/inverse_dynamics.hpp"

#include "model/chain_kinematics.hpp"

namespace flexcomp::simulation {
namespace {

using Vector = Vector3<double>;
using Matrix = Matrix3<double>;

/// A link on its way, in its own frame: there its inertia is as the model has it.
struct Motion {
  Vector spin = Vector::Zero();                  ///< rad/s
  Vector angular_acceleration = Vector::Zero();  ///< rad/s²
  Vector acceleration = Vector::Zero();          ///< of the origin, less gravity, m/s²

  /// Acceleration of a point that is fixed to the link, `arm` away from its origin.
  Vector acceleration_at(const Vector& arm) const {
    return acceleration + angular_acceleration.cross(arm) + spin.cross(spin.cross(arm));
  }
};

/// A link's frame in the one before, and force and moment about its origin that move it and all
/// links beyond, in its own frame.
struct Link {
  Pose<double> frame;
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

/// The motion of a link whose `frame` in the one before is as its joint holds it.
Motion next(const Motion& before, const model::ChainJoint& joint, const JointMotion& by,
            const Pose<double>& frame) {
  const auto turned = [&](const Vector& vector) -> Vector {
    return frame.rotation.transpose() * vector;
  };
  Motion motion;
  motion.spin = turned(before.spin);
  motion.angular_acceleration = turned(before.angular_acceleration);
  motion.acceleration = turned(before.acceleration_at(frame.position));
  const Vector velocity = by.velocity * joint.axis;
  if (joint.slides()) {  // on a link that turns, what slides is turned as well (Coriolis)
    motion.acceleration += by.acceleration * joint.axis + 2 * motion.spin.cross(velocity);
  } else {
    motion.angular_acceleration += by.acceleration * joint.axis + motion.spin.cross(velocity);
    motion.spin += velocity;
  }
  return motion;
}

}  // namespace

JointValues inverse_dynamics(const model::Robot& robot, const JointValues& q,
                             const JointValues& velocity, const JointValues& acceleration) {
  const model::Chain& chain = robot.elastic;
  model::PerJoint<Link> links(chain.joints.size());
  Motion motion;
  motion.acceleration = -chain.gravity;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const model::ChainJoint& joint = chain.joints[i];
    Link& link = links[i];
    link.frame = model::moved(joint.origin, joint, q[at]);
    motion = next(motion, joint, {q[at], velocity[at], acceleration[at]}, link.frame);
    link.add(joint.center_of_mass, joint.mass * motion.acceleration_at(joint.center_of_mass));
    const Matrix& inertia = robot.link_inertia[i];
    link.moment += inertia * motion.angular_acceleration + motion.spin.cross(inertia * motion.spin);
  }
  const Vector payload = chain.tool.position + chain.tool.rotation * chain.payload_center;
  links.back().add(payload, chain.payload_mass * motion.acceleration_at(payload));
  JointValues torque(chain.size());
  for (std::size_t i = links.size(); i-- > 0;) {
    const Link& link = links[i];
    const model::ChainJoint& joint = chain.joints[i];
    torque[static_cast<Eigen::Index>(i)] = joint_load(joint, joint.axis, link.force, link.moment);
    if (i > 0) {
      links[i - 1].moment += link.frame.rotation * link.moment;
      links[i - 1].add(link.frame.position, link.frame.rotation * link.force);
    }
  }
  return torque;
}

}  // namespace flexcomp::simulation
