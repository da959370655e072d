#pragma once

#include <Eigen/Core>

namespace flexcomp {

template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <typename Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

/// Force (N) in the first three rows, moment (N·m) at the TCP in the last three.
template <typename Scalar>
using Wrench = Eigen::Matrix<Scalar, 6, 1>;

/// Small displacement: translation (m) in the first three rows, rotation vector (rad) in the last.
template <typename Scalar>
using Twist = Eigen::Matrix<Scalar, 6, 1>;

/// Maps a wrench to a twist (or the six diagonal terms of such a map).
template <typename Scalar>
using Compliance = Eigen::Matrix<Scalar, 6, 6>;
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
  Matrix3<Scalar> rotation = Matrix3<Scalar>::Identity();
  Vector3<Scalar> position = Vector3<Scalar>::Zero();

  Pose operator*(const Pose& inner) const {
    return {rotation * inner.rotation, rotation * inner.position + position};
  }
};

}  // namespace flexcomp
