#include "flexcomp/inverse_dynamics.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// A rotation whose third column is `axis`.
template <typename Scalar>
Matrix3<Scalar> frame_along(const Vector3<Scalar>& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vector3<Scalar> across = axis.cross(Vector3<Scalar>::Unit(least)).normalized();
  Matrix3<Scalar> frame;
  frame << across, axis.cross(across), axis;
  return frame;
}

/// Second moment ∫x xᵀ dm of an inertia.
template <typename Scalar>
Matrix3<Scalar> second_moment(const Matrix3<Scalar>& inertia) {
  return inertia.trace() / Scalar(2) * Matrix3<Scalar>::Identity() - inertia;
}

/// Whether no principal minor of a symmetric matrix, with entries up to about 1, is below zero by
/// more than `rounding`.
template <typename Scalar>
bool is_semidefinite(const Matrix3<Scalar>& p, Scalar rounding) {
  const Scalar of_xy = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  const Scalar of_xz = p(0, 0) * p(2, 2) - p(0, 2) * p(2, 0);
  const Scalar of_yz = p(1, 1) * p(2, 2) - p(1, 2) * p(2, 1);
  const Scalar of_all = p.row(0).dot(p.row(1).cross(p.row(2)));
  return p.diagonal().minCoeff() >= -rounding && of_xy >= -rounding && of_xz >= -rounding &&
         of_yz >= -rounding && of_all >= -rounding;
}

/// Symmetric, and of a body: its second moment is positive semidefinite.
template <typename Scalar>
bool is_inertia(const Matrix3<Scalar>& inertia) {
  const Scalar size = inertia.cwiseAbs().maxCoeff();
  if (!inertia.allFinite() || size == Scalar(0)) {
    return inertia.allFinite();
  }
  constexpr auto kRounding = Scalar(1e-4);
  const Matrix3<Scalar> unit = inertia / size;
  return (unit - unit.transpose()).cwiseAbs().maxCoeff() <= kRounding &&
         is_semidefinite<Scalar>(second_moment<Scalar>(unit), kRounding);
}

/// Rotation * (turn by the joint angle about z).
template <typename Scalar>
Matrix3<Scalar> turned(const Matrix3<Scalar>& rotation, Scalar angle) {
  const Scalar s = std::sin(angle);
  const Scalar c = std::cos(angle);
  Matrix3<Scalar> r;
  r.col(0) = c * rotation.col(0) + s * rotation.col(1);
  r.col(1) = c * rotation.col(1) - s * rotation.col(0);
  r.col(2) = rotation.col(2);
  return r;
}

/// How a link moves, in its own frame.
template <typename Scalar>
struct LinkMotion {
  Vector3<Scalar> spin = Vector3<Scalar>::Zero();            ///< rad/s
  Vector3<Scalar> reference_spin = Vector3<Scalar>::Zero();  ///< rad/s
  Vector3<Scalar> angular = Vector3<Scalar>::Zero();         ///< rad/s²
  Vector3<Scalar> linear = Vector3<Scalar>::Zero();          ///< of the origin, less gravity, m/s²
};

}  // namespace

template <typename Scalar, int Joints>
Result InverseDynamics<Scalar, Joints>::configure(const RobotModel<Scalar, Joints>& model,
                                                  const LinkInertia<Scalar, Joints>& inertia) {
  if (validate(model) != Result::ok) {
    return Result::bad_model;
  }
  InverseDynamics made;
  Matrix3<Scalar> before = Matrix3<Scalar>::Identity();
  for (std::size_t i = 0; i < made.links_.size(); ++i) {
    const Joint<Scalar>& joint = model.joints[i];
    if (!is_inertia(inertia[i])) {
      return Result::bad_model;
    }
    const Matrix3<Scalar> frame = frame_along<Scalar>(joint.axis);
    const Vector3<Scalar> center = frame.transpose() * joint.center_of_mass;
    Link& link = made.links_[i];
    link.rotation = before.transpose().lazyProduct(joint.origin.rotation).eval().lazyProduct(frame);
    link.position = before.transpose() * joint.origin.position;
    link.mass = joint.mass;
    link.moment = joint.mass * center;
    link.second =
        frame.transpose().lazyProduct(second_moment<Scalar>(inertia[i])).eval().lazyProduct(frame) +
        link.moment * center.transpose();
    before = frame;
  }
  Link& last = made.links_.back();
  const Vector3<Scalar> payload =
      before.transpose() * (model.tool.position + model.tool.rotation * model.payload_center);
  last.mass += model.payload_mass;
  last.moment += model.payload_mass * payload;
  last.second += model.payload_mass * payload * payload.transpose();
  for (Link& link : made.links_) {
    // I = tr(P) − P, the inverse of P = ½ tr(I) − I.
    link.inertia = link.second.trace() * Matrix3<Scalar>::Identity() - link.second;
  }
  made.gravity_ = model.gravity;
  *this = made;
  return Result::ok;
}

template <typename Scalar, int Joints>
auto InverseDynamics<Scalar, Joints>::torque(const Angles& q, const Angles& velocity,
                                             const Angles& reference_velocity,
                                             const Angles& acceleration) const -> Angles {
  using Vector = Vector3<Scalar>;
  constexpr auto kJoints = static_cast<std::size_t>(Joints);
  std::array<Matrix3<Scalar>, kJoints> rotation;
  std::array<Vector, kJoints> force;
  std::array<Vector, kJoints> moment;
  LinkMotion<Scalar> motion;
  motion.linear = -gravity_;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const Link& link = links_[i];
    rotation[i] = turned(link.rotation, q[joint]);
    const auto inward = rotation[i].transpose();
    const Vector& arm = link.position;
    motion.linear = (inward * (motion.linear + motion.angular.cross(arm) +
                               motion.reference_spin.cross(motion.spin.cross(arm))))
                        .eval();
    motion.spin = (inward * motion.spin).eval();
    motion.reference_spin = (inward * motion.reference_spin).eval();
    motion.angular = (inward * motion.angular).eval();
    motion.angular.x() += reference_velocity[joint] * motion.spin.y();
    motion.angular.y() -= reference_velocity[joint] * motion.spin.x();
    motion.angular.z() += acceleration[joint];
    motion.spin.z() += velocity[joint];
    motion.reference_spin.z() += reference_velocity[joint];
    force[i] = link.mass * motion.linear + motion.angular.cross(link.moment) +
               motion.reference_spin.cross(motion.spin.cross(link.moment));
    const Vector second = link.second * motion.reference_spin;
    moment[i] = link.moment.cross(motion.linear) + link.inertia * motion.angular +
                second.cross(motion.spin);
  }
  Angles torque;
  for (std::size_t i = kJoints; i-- > 0;) {
    torque[static_cast<Eigen::Index>(i)] = moment[i].z();
    if (i > 0) {
      const Vector carried = rotation[i] * force[i];
      force[i - 1] += carried;
      moment[i - 1] += rotation[i] * moment[i] + links_[i].position.cross(carried);
    }
  }
  return torque;
}

#define FLEXCOMP_INVERSE_DYNAMICS(Scalar, Joints) template class InverseDynamics<Scalar, Joints>;
FLEXCOMP_INSTANTIATE_CONTROL(FLEXCOMP_INVERSE_DYNAMICS)

}  // namespace flexcomp
