#include "table_certificate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// Largest stretch of a 3×3 matrix, from above: the closed form for the eigenvalues loses half the
/// digits, for which the factor makes up.
template <typename Scalar>
Scalar spectral_norm(const Matrix3<Scalar>& m) {
  const Scalar scale = m.cwiseAbs().maxCoeff();
  if (!(scale > Scalar(0))) {
    return Scalar(0);
  }
  const Matrix3<Scalar> unit = m / scale;
  Eigen::SelfAdjointEigenSolver<Matrix3<Scalar>> solver;
  solver.computeDirect(unit.lazyProduct(unit.transpose()), Eigen::EigenvaluesOnly);
  const Scalar largest = solver.eigenvalues()[2];
  return Scalar(1.001) * scale * std::sqrt(largest > Scalar(0) ? largest : Scalar(0));
}

/// Error for the worst wrench, given the error as a compliance and as a constant twist.
template <typename Scalar>
TableError<Scalar> worst_case(const Compliance<Scalar>& compliance, const Twist<Scalar>& twist,
                              const WrenchBound<Scalar>& bound) {
  const auto block = [&](Eigen::Index row, Eigen::Index column) {
    const Matrix3<Scalar> part = compliance.template block<3, 3>(row, column);
    return spectral_norm<Scalar>(part);
  };
  return {block(0, 0) * bound.force + block(0, 3) * bound.moment + twist.template head<3>().norm(),
          block(3, 0) * bound.force + block(3, 3) * bound.moment + twist.template tail<3>().norm()};
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> linear_compliance(const RobotModel<Scalar, Joints>& model) {
  JointVector<Scalar, Joints> compliance;
  for (std::size_t i = 0; i < Joints; ++i) {
    compliance[static_cast<Eigen::Index>(i)] = model.joints[i].compliance;
  }
  return compliance;
}

/// Length of the linear or angular part of a column of a Jacobian.
template <typename Scalar, int Joints>
Scalar linear_norm(const Jacobian<Scalar, Joints>& jacobian, Eigen::Index joint) {
  return jacobian.col(joint).template head<3>().norm();
}

template <typename Scalar, int Joints>
Scalar angular_norm(const Jacobian<Scalar, Joints>& jacobian, Eigen::Index joint) {
  return jacobian.col(joint).template tail<3>().norm();
}

/// The most that the cubic part of the joint springs can add to the error: each spring's share by
/// the triangle inequality.
template <typename Scalar, int Joints>
TableError<Scalar> cubic_error(const RobotModel<Scalar, Joints>& model,
                               const TableEntry<Scalar, Joints>& exact,
                               const TableEntry<Scalar, Joints>& entry,
                               const WrenchBound<Scalar>& bound) {
  const Jacobian<Scalar, Joints> change = entry.jacobian - exact.jacobian;
  TableError<Scalar> error;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    const Scalar cubic = std::abs(model.joints[static_cast<std::size_t>(i)].cubic_compliance);
    const Scalar change_linear = linear_norm<Scalar, Joints>(change, i);
    const Scalar change_angular = angular_norm<Scalar, Joints>(change, i);
    const Scalar torque_change = change_linear * bound.force + change_angular * bound.moment +
                                 std::abs(entry.weight_torque[i] - exact.weight_torque[i]);
    const Scalar torque = linear_norm<Scalar, Joints>(exact.jacobian, i) * bound.force +
                          angular_norm<Scalar, Joints>(exact.jacobian, i) * bound.moment +
                          std::abs(exact.weight_torque[i]) + torque_change;
    const Scalar windup = cubic * torque * torque * torque;
    const Scalar windup_change = Scalar(3) * cubic * torque * torque * torque_change;
    error.position +=
        change_linear * windup +
        (linear_norm<Scalar, Joints>(exact.jacobian, i) + change_linear) * windup_change;
    error.orientation += change_angular * windup + (Scalar(1) + change_angular) * windup_change;
  }
  return error;
}

/// How far each joint is, at most, from the TCP or a weight it carries, and what that weight is.
template <typename Scalar, int Joints>
struct Reach {
  JointVector<Scalar, Joints> lever;
  JointVector<Scalar, Joints> weight;         ///< N, beyond the joint
  JointVector<Scalar, Joints> weight_torque;  ///< N·m
  Scalar base_lever;
  Scalar base_weight_moment;

  explicit Reach(const RobotModel<Scalar, Joints>& model) {
    const Scalar gravity = model.gravity.norm();
    const Scalar payload = model.tool.position.norm() + model.payload_center.norm();
    Scalar force = model.payload_mass * gravity;
    Scalar moment = force * payload;
    Scalar farthest = force > Scalar(0) ? payload : static_cast<Scalar>(model.tool.position.norm());
    for (std::size_t i = Joints; i-- > 0;) {
      const auto joint = static_cast<Eigen::Index>(i);
      const Scalar own_weight = model.joints[i].mass * gravity;
      const Scalar own_lever = model.joints[i].center_of_mass.norm();
      force += own_weight;
      moment += own_weight * own_lever;
      farthest = own_weight > Scalar(0) ? std::max(farthest, own_lever) : farthest;
      lever[joint] = farthest;
      weight[joint] = force;
      weight_torque[joint] = moment;
      const Scalar length = model.joints[i].origin.position.norm();
      farthest += length;
      moment += force * length;
    }
    base_lever = farthest;
    base_weight_moment = moment;
  }
};

/// Second derivative of the deflection of one set of structure springs: four factors that turn with
/// the joints (lever, rotation, rotation, lever), hence 16.
template <typename Scalar>
TableError<Scalar> spring_curvature(const DiagonalCompliance<Scalar>& compliance, Scalar lever,
                                    Scalar force, Scalar moment) {
  const Scalar shift = compliance.template head<3>().maxCoeff();
  const Scalar turn = compliance.template tail<3>().maxCoeff();
  return {Scalar(16) * (shift * force + lever * turn * moment), Scalar(16) * turn * moment};
}

template <typename Scalar>
TableError<Scalar> sum(const TableError<Scalar>& a, const TableError<Scalar>& b) {
  return {a.position + b.position, a.orientation + b.orientation};
}

}  // namespace

template <typename Scalar, int Joints>
ModelBounds<Scalar, Joints> model_bounds(const RobotModel<Scalar, Joints>& model,
                                         const WrenchBound<Scalar>& bound) {
  const Reach<Scalar, Joints> reach(model);
  ModelBounds<Scalar, Joints> bounds;
  bounds.lever = reach.lever;
  bounds.torque = bound.force * reach.lever + JointVector<Scalar, Joints>::Constant(bound.moment) +
                  reach.weight_torque;
  TableError<Scalar> magnitude;
  for (std::size_t i = 0; i < Joints; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const Scalar torque = bounds.torque[joint];
    // c3 τ³ has four turning factors with J where c1 τ has two, and (4/2)² = 4.
    bounds.cubic[joint] = std::abs(model.joints[i].cubic_compliance) * torque;
    bounds.compliance[joint] =
        model.joints[i].compliance + Scalar(4) * bounds.cubic[joint] * torque;
    magnitude.position += bounds.compliance[joint] * torque * reach.lever[joint];
    magnitude.orientation += bounds.compliance[joint] * torque;
    bounds.structure_curvature =
        sum(bounds.structure_curvature,
            spring_curvature<Scalar>(model.joints[i].link_compliance, reach.lever[joint],
                                     bound.force + reach.weight[joint], torque));
  }
  const Scalar payload = model.payload_mass * model.gravity.norm();
  bounds.structure_curvature =
      sum(bounds.structure_curvature,
          sum(spring_curvature<Scalar>(
                  model.base_compliance, reach.base_lever, bound.force + reach.weight[0],
                  bound.moment + bound.force * reach.base_lever + reach.base_weight_moment),
              spring_curvature<Scalar>(model.tool_compliance, Scalar(0), bound.force + payload,
                                       bound.moment + payload * model.payload_center.norm())));
  // Some thirty roundings in a row at worst, each of half a unit in the last place.
  constexpr Scalar kRounding = Scalar(16) * Scalar(std::numeric_limits<float>::epsilon());
  bounds.rounding = {
      kRounding * (magnitude.position + bounds.structure_curvature.position / Scalar(16)),
      kRounding * (magnitude.orientation + bounds.structure_curvature.orientation / Scalar(16))};
  return bounds;
}

template <typename Scalar, int Joints>
TableError<Scalar> entry_error(const RobotModel<Scalar, Joints>& model,
                               const TableEntry<Scalar, Joints>& exact,
                               const TableEntry<Scalar, Joints>& entry,
                               const WrenchBound<Scalar>& bound) {
  const JointVector<Scalar, Joints> compliance = linear_compliance(model);
  const Jacobian<Scalar, Joints> exact_springs = exact.jacobian * compliance.asDiagonal();
  const Jacobian<Scalar, Joints> entry_springs = entry.jacobian * compliance.asDiagonal();
  const Compliance<Scalar> blended = exact_springs.lazyProduct(entry.jacobian.transpose());

  const Compliance<Scalar> predicted =
      entry_springs.lazyProduct(entry.jacobian.transpose()) + entry.structure -
      exact_springs.lazyProduct(exact.jacobian.transpose()) - exact.structure;
  const Twist<Scalar> predicted_weight =
      entry_springs.lazyProduct(entry.weight_torque) + entry.structure_weight -
      exact_springs.lazyProduct(exact.weight_torque) - exact.structure_weight;

  const Compliance<Scalar> left = exact_springs.lazyProduct(exact.jacobian.transpose()) - blended +
                                  exact.structure -
                                  exact.jacobian.lazyProduct(entry.structure_motion);
  const Twist<Scalar> left_weight =
      exact_springs.lazyProduct(exact.weight_torque - entry.weight_torque) +
      exact.structure_weight - exact.jacobian.lazyProduct(entry.structure_weight_motion);

  return sum(larger(worst_case<Scalar>(predicted, predicted_weight, bound),
                    worst_case<Scalar>(left, left_weight, bound)),
             cubic_error(model, exact, entry, bound));
}

template <typename Scalar, int Joints>
TableError<Scalar> segment_curvature(const ModelBounds<Scalar, Joints>& bounds,
                                     const TableEntry<Scalar, Joints>& from,
                                     const TableEntry<Scalar, Joints>& to,
                                     const WrenchBound<Scalar>& bound,
                                     const SegmentMotion<Scalar>& motion) {
  const Scalar v = motion.joint_speed;
  const Scalar t1 = motion.blend_speed;
  const Scalar t2 = motion.blend_acceleration;
  const Jacobian<Scalar, Joints> change = to.jacobian - from.jacobian;
  TableError<Scalar> curvature{v * v * bounds.structure_curvature.position,
                               v * v * bounds.structure_curvature.orientation};
  for (Eigen::Index i = 0; i < Joints; ++i) {
    const Scalar linear = linear_norm<Scalar, Joints>(change, i);
    const Scalar angular = angular_norm<Scalar, Joints>(change, i);
    const Scalar torque = bounds.torque[i];
    const Scalar torque_change = linear * bound.force + angular * bound.moment +
                                 std::abs(to.weight_torque[i] - from.weight_torque[i]);
    const auto motion_bound = [&](const TableEntry<Scalar, Joints>& entry) {
      return entry.structure_motion.row(i).template head<3>().norm() * bound.force +
             entry.structure_motion.row(i).template tail<3>().norm() * bound.moment +
             std::abs(entry.structure_weight_motion[i]);
    };
    const Scalar structure = std::max(motion_bound(from), motion_bound(to));
    const Scalar structure_change = motion_bound(from) + motion_bound(to);

    // Model: J k τ twice over. Blend alone, then model times blend; then J times the blended motion
    // that makes up for the other springs.
    const auto part = [&](Scalar lever, Scalar lever_change) {
      const Scalar model = Scalar(4) * v * v * lever * torque;
      const Scalar blend = Scalar(2) * lever_change * torque_change * t1 * t1 +
                           (lever_change * torque + lever * torque_change) * t2;
      const Scalar mixed = v * v * lever * torque + Scalar(2) * v * lever * torque_change * t1 +
                           lever * torque_change * t2;
      const Scalar motions = lever * (v * v * structure + Scalar(2) * v * t1 * structure_change +
                                      t2 * structure_change);
      const Scalar cubic =
          Scalar(6) * bounds.cubic[i] * lever * torque_change * torque_change * t1 * t1;
      return bounds.compliance[i] * (model + std::max(blend, mixed)) + cubic + motions;
    };
    curvature.position += part(bounds.lever[i], linear);
    curvature.orientation += part(Scalar(1), angular);
  }
  // The other springs' own blend is linear in the blend factor.
  const Compliance<Scalar> structure_change = to.structure - from.structure;
  const Twist<Scalar> structure_weight_change = to.structure_weight - from.structure_weight;
  const TableError<Scalar> blended =
      worst_case<Scalar>(structure_change, structure_weight_change, bound);
  return sum(curvature, {t2 * blended.position, t2 * blended.orientation});
}

template <typename Scalar, int Joints>
TableError<Scalar> box_curvature(const ModelBounds<Scalar, Joints>& bounds) {
  TableError<Scalar> curvature;
  for (Eigen::Index i = 0; i < Joints; ++i) {
    const Scalar spring = Scalar(7) * bounds.compliance[i] * bounds.torque[i];
    curvature.position += spring * bounds.lever[i];
    curvature.orientation += spring;
  }
  return curvature;
}

#define FLEXCOMP_TABLE_CERTIFICATE(Scalar, Joints)                                     \
  template ModelBounds<Scalar, Joints> model_bounds(const RobotModel<Scalar, Joints>&, \
                                                    const WrenchBound<Scalar>&);       \
  template TableError<Scalar> entry_error(                                             \
      const RobotModel<Scalar, Joints>&, const TableEntry<Scalar, Joints>&,            \
      const TableEntry<Scalar, Joints>&, const WrenchBound<Scalar>&);                  \
  template TableError<Scalar> segment_curvature(                                       \
      const ModelBounds<Scalar, Joints>&, const TableEntry<Scalar, Joints>&,           \
      const TableEntry<Scalar, Joints>&, const WrenchBound<Scalar>&,                   \
      const SegmentMotion<Scalar>&);                                                   \
  template TableError<Scalar> box_curvature(const ModelBounds<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE(FLEXCOMP_TABLE_CERTIFICATE)

}  // namespace flexcomp
