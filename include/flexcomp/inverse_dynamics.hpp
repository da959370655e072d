#pragma once

/// @file
/// Torques of inertia, motion and weight.

#include <array>

#include "flexcomp/model.hpp"

namespace flexcomp {

/// Inertia (kg·m²) of each moved link about its centre of mass, in the link frame.
template <typename Scalar, int Joints>
using LinkInertia = std::array<Matrix3<Scalar>, static_cast<std::size_t>(Joints)>;

/// Rigid-body inverse dynamics with two velocity arguments, by a modified recursive Newton–Euler.
///
/// τ = D(q) a + C(q, q') r + G(q), with the velocity q' and a reference velocity r that a
/// controller chose. C is the matrix of Christoffel symbols, so that D' − 2C is skew, on which the
/// stability of passivity-based controllers rests (Slotine and Li 1987; De Luca and Ferrajoli 2009
/// for the recursion). With r = q' and a = q'' it is the ordinary inverse dynamics.
///
/// It comes out of the acceleration that a particle at x has when the arm moves at q' and r is
/// differentiated along: a + α×x + ω_r×(ω×x). Summed over a link this needs its mass, first moment
/// h, inertia I and second moment P = ∫x xᵀ dm = ½ tr(I) − I, about the link frame's origin:
///   force m a + α×h + ω_r×(ω×h),   moment h×a + I α + (P ω_r)×ω.
/// Each link frame is turned so that its joint's axis is z, which saves a third of the operations.
template <typename Scalar, int Joints>
class InverseDynamics {
 public:
  using Angles = JointVector<Scalar, Joints>;  ///< one number a joint

  /// Takes geometry, masses, gravity and payload (a point mass) from the model. Returns ok, or
  /// bad_model for a model or an inertia that cannot be; then nothing has changed.
  Result configure(const RobotModel<Scalar, Joints>& model,
                   const LinkInertia<Scalar, Joints>& inertia);

  /// Torques (N·m) at angles `q` (rad), `velocity` and `reference_velocity` (rad/s) and
  /// `acceleration` (rad/s²). About 230 multiplications and a sine and cosine a joint.
  Angles torque(const Angles& q, const Angles& velocity, const Angles& reference_velocity,
                const Angles& acceleration) const;

 private:
  /// A link, its frame turned so that z is its joint's axis.
  struct Link {
    /// In the frame before, at a joint angle of zero.
    Matrix3<Scalar> rotation = Matrix3<Scalar>::Identity();
    Vector3<Scalar> position = Vector3<Scalar>::Zero();  ///< m, in the frame before
    Scalar mass = 0;                                     ///< kg
    Vector3<Scalar> moment = Vector3<Scalar>::Zero();    ///< kg·m, first moment
    Matrix3<Scalar> inertia = Matrix3<Scalar>::Zero();   ///< kg·m², about the origin
    Matrix3<Scalar> second = Matrix3<Scalar>::Zero();    ///< kg·m², second moment P, the same
  };

  std::array<Link, static_cast<std::size_t>(Joints)> links_;
  Vector3<Scalar> gravity_ = Vector3<Scalar>::Zero();
};

}  // namespace flexcomp
