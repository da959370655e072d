#pragma once

#include "flexcomp/table_builder.hpp"
#include "table_record.hpp"

namespace flexcomp {

/// Largest wrench that a certificate is for.
template <typename Scalar>
struct WrenchBound {
  Scalar force;
  Scalar moment;
};

/// Bounds, over all postures, on what a model's joints carry and how it reacts: the constants of
/// the certificate.
///
/// With R_i the largest distance of joint i from the TCP or from a weight it carries, turning any
/// joint by an angle moves J's column i, and each of its first and second derivatives, by no more
/// than R_i (linear part) and 1 (angular part), whichever joint turns. A product of m such factors
/// therefore has a second derivative of at most m² times the product of their bounds.
template <typename Scalar, int Joints>
struct ModelBounds {
  JointVector<Scalar, Joints> lever;       ///< R_i, m
  JointVector<Scalar, Joints> torque;      ///< largest torque at joint i, N·m
  JointVector<Scalar, Joints> compliance;  ///< c1 + 4 |c3| torque², rad/(N·m)
  JointVector<Scalar, Joints> cubic;       ///< |c3| torque, rad/(N·m)²
  TableError<Scalar> structure_curvature;  ///< second derivative of the other springs' deflection
  TableError<Scalar> rounding;             ///< what float arithmetic in a lookup can add
};

template <typename Scalar, int Joints>
ModelBounds<Scalar, Joints> model_bounds(const RobotModel<Scalar, Joints>& model,
                                         const WrenchBound<Scalar>& bound);

/// Error of an entry for the worst wrench within the bound: the larger of the error of the
/// predicted deflection and of what is left of the true deflection after the entry's correction.
template <typename Scalar, int Joints>
TableError<Scalar> entry_error(const RobotModel<Scalar, Joints>& model,
                               const TableEntry<Scalar, Joints>& exact,
                               const TableEntry<Scalar, Joints>& entry,
                               const WrenchBound<Scalar>& bound);

/// How fast blends of two records can bend away from the model along a straight move in joint
/// space.
template <typename Scalar>
struct SegmentMotion {
  Scalar joint_speed;         ///< 1-norm of the joint velocity
  Scalar blend_speed;         ///< first derivative of the blend
  Scalar blend_acceleration;  ///< second derivative of the blend
};

/// Bound on the second derivative of `entry_error`'s error vectors between the records of a
/// segment.
template <typename Scalar, int Joints>
TableError<Scalar> segment_curvature(const ModelBounds<Scalar, Joints>& bounds,
                                     const TableEntry<Scalar, Joints>& from,
                                     const TableEntry<Scalar, Joints>& to,
                                     const WrenchBound<Scalar>& bound,
                                     const SegmentMotion<Scalar>& motion);

/// Bound on each pure second derivative of the error vectors inside a box of a grid: 7 ΣkR·torque,
/// of which 4 come from the model, 3 from its product with the multilinear blend (which moves no
/// faster than the model does).
template <typename Scalar, int Joints>
TableError<Scalar> box_curvature(const ModelBounds<Scalar, Joints>& bounds);

template <typename Scalar>
TableError<Scalar> larger(const TableError<Scalar>& a, const TableError<Scalar>& b) {
  return {a.position > b.position ? a.position : b.position,
          a.orientation > b.orientation ? a.orientation : b.orientation};
}

}  // namespace flexcomp
