#pragma once

/// @file
/// Kinematics of a serial chain.

#include <Eigen/Geometry>
#include <array>

#include "flexcomp/model.hpp"

namespace flexcomp {

/// Where everything is at one set of joint angles; all in the robot base frame.
template <typename Scalar, int Joints>
struct Kinematics {
  std::array<Pose<Scalar>, Joints> links;    ///< frame of the link that joint i moves
  std::array<Vector3<Scalar>, Joints> axes;  ///< unit axis of joint i
  Pose<Scalar> tcp;                          ///< tool centre point
};

/// Forward kinematics at joint angles `q` (rad). Exact for any serial chain of revolute joints.
template <typename Scalar, int Joints>
Kinematics<Scalar, Joints> forward_kinematics(const RobotModel<Scalar, Joints>& model,
                                              const JointVector<Scalar, Joints>& q);

/// Geometric Jacobian of a point fixed to the last link, rows [linear; angular], base frame.
///
/// Column i is [z_i × (point − o_i); z_i] with z_i the axis and o_i the origin of joint i.
template <typename Scalar, int Joints>
Jacobian<Scalar, Joints> geometric_jacobian(const Kinematics<Scalar, Joints>& kinematics,
                                            const Vector3<Scalar>& point);

/// Geometric Jacobian of the TCP.
template <typename Scalar, int Joints>
Jacobian<Scalar, Joints> geometric_jacobian(const Kinematics<Scalar, Joints>& kinematics) {
  return geometric_jacobian<Scalar, Joints>(kinematics, kinematics.tcp.position);
}

/// The small displacement that takes pose `from` to pose `to`: translation of the origin, and the
/// rotation vector of `to.rotation * from.rotationᵀ`, base frame.
template <typename Scalar>
Twist<Scalar> pose_difference(const Pose<Scalar>& from, const Pose<Scalar>& to);

/// Pose displaced by a twist given at its origin in the outer frame.
template <typename Scalar>
Pose<Scalar> displaced(const Pose<Scalar>& pose, const Twist<Scalar>& twist);

/// Rotation by `angle` (rad) about the unit vector `axis` (Rodrigues).
template <typename Scalar>
Matrix3<Scalar> axis_rotation(const Vector3<Scalar>& axis, Scalar angle);

}  // namespace flexcomp
