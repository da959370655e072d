#pragma once

/// @file
/// Vectors, matrices and poses.

#include <Eigen/Core>

// By itself Eigen aligns to the widest vector registers that a file is compiled for. Where the
// library was compiled for others, numbers would be read from places where they do not lie.
#if EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error "Link flexcomp::core, or define EIGEN_MAX_STATIC_ALIGN_BYTES=16 in every file with Eigen"
#endif

/// The real-time core. No heap, exceptions, RTTI, locks or I/O.
namespace flexcomp {

/// Three numbers, m where it is a place.
template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
/// Three by three: a rotation, an inertia.
template <typename Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

/// Force (N) in the first three rows, moment (N·m) at the TCP in the last three.
template <typename Scalar>
using Wrench = Eigen::Matrix<Scalar, 6, 1>;

/// Small displacement: translation (m) in the first three rows, rotation vector (rad) in the last.
template <typename Scalar>
using Twist = Eigen::Matrix<Scalar, 6, 1>;

/// Maps a wrench to a twist.
template <typename Scalar>
using Compliance = Eigen::Matrix<Scalar, 6, 6>;
/// The six diagonal terms of a compliance: m/N (3), rad/(N·m) (3).
template <typename Scalar>
using DiagonalCompliance = Eigen::Matrix<Scalar, 6, 1>;

/// One number a joint: angles (rad), torques (N·m) or wind-ups (rad).
template <typename Scalar, int Joints>
using JointVector = Eigen::Matrix<Scalar, Joints, 1>;

/// Maps joint rates to the twist of the TCP; linear rows first.
template <typename Scalar, int Joints>
using Jacobian = Eigen::Matrix<Scalar, 6, Joints>;

/// Rigid placement of one frame in another: x_outer = rotation * x_inner + position.
template <typename Scalar>
struct Pose {
  Matrix3<Scalar> rotation = Matrix3<Scalar>::Identity();  ///< orthonormal, determinant 1
  Vector3<Scalar> position = Vector3<Scalar>::Zero();      ///< m

  /// Placement in the outer frame of what is placed in the inner.
  Pose operator*(const Pose& inner) const {
    return {rotation * inner.rotation, rotation * inner.position + position};
  }
};

/// Placement of the outer frame in the inner.
template <typename Scalar>
Pose<Scalar> inverse(const Pose<Scalar>& pose) {
  const Matrix3<Scalar> back = pose.rotation.transpose();
  return {back, -(back * pose.position)};
}

}  // namespace flexcomp
