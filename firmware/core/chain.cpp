#include "flexcomp/chain.hpp"

#include <cmath>

#include "instantiate.hpp"

namespace flexcomp {

template <typename Scalar>
Matrix3<Scalar> axis_rotation(const Vector3<Scalar>& axis, Scalar angle) {
  const Scalar s = std::sin(angle);
  const Scalar c = std::cos(angle);
  const Vector3<Scalar> u = (Scalar(1) - c) * axis;
  Matrix3<Scalar> r;
  r << c + u.x() * axis.x(), u.x() * axis.y() - s * axis.z(), u.x() * axis.z() + s * axis.y(),
      u.y() * axis.x() + s * axis.z(), c + u.y() * axis.y(), u.y() * axis.z() - s * axis.x(),
      u.z() * axis.x() - s * axis.y(), u.z() * axis.y() + s * axis.x(), c + u.z() * axis.z();
  return r;
}

template <typename Scalar>
Twist<Scalar> pose_difference(const Pose<Scalar>& from, const Pose<Scalar>& to) {
  const Matrix3<Scalar> r = to.rotation.lazyProduct(from.rotation.transpose());
  // The skew part is sin(angle) * axis; atan2 keeps full precision for small and large angles.
  const Vector3<Scalar> skew(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  const Scalar sine = skew.norm() / Scalar(2);
  const Scalar cosine = (r.trace() - Scalar(1)) / Scalar(2);
  const Scalar angle = std::atan2(sine, cosine);
  const Scalar scale = sine > Scalar(0) ? angle / (Scalar(2) * sine) : Scalar(0.5);
  Twist<Scalar> twist;
  twist.template head<3>() = to.position - from.position;
  twist.template tail<3>() = scale * skew;
  return twist;
}

template <typename Scalar>
Pose<Scalar> displaced(const Pose<Scalar>& pose, const Twist<Scalar>& twist) {
  const Vector3<Scalar> rotation = twist.template tail<3>();
  const Scalar angle = rotation.norm();
  const Vector3<Scalar> axis =
      angle > Scalar(0) ? Vector3<Scalar>(rotation / angle) : Vector3<Scalar>::UnitZ();
  return {axis_rotation<Scalar>(axis, angle) * pose.rotation,
          pose.position + twist.template head<3>()};
}

template <typename Scalar, int Joints>
Kinematics<Scalar, Joints> forward_kinematics(const RobotModel<Scalar, Joints>& model,
                                              const JointVector<Scalar, Joints>& q) {
  Kinematics<Scalar, Joints> kinematics;
  Pose<Scalar> pose;
  for (std::size_t i = 0; i < Joints; ++i) {
    const Joint<Scalar>& joint = model.joints[i];
    pose = pose * joint.origin;
    kinematics.axes[i] = pose.rotation * joint.axis;
    pose.rotation =
        pose.rotation * axis_rotation<Scalar>(joint.axis, q[static_cast<Eigen::Index>(i)]);
    kinematics.links[i] = pose;
  }
  kinematics.tcp = pose * model.tool;
  return kinematics;
}

template <typename Scalar, int Joints>
Jacobian<Scalar, Joints> geometric_jacobian(const Kinematics<Scalar, Joints>& kinematics,
                                            const Vector3<Scalar>& point) {
  Jacobian<Scalar, Joints> jacobian;
  for (std::size_t i = 0; i < Joints; ++i) {
    const Vector3<Scalar>& axis = kinematics.axes[i];
    const Vector3<Scalar> lever = point - kinematics.links[i].position;
    jacobian.col(static_cast<Eigen::Index>(i)) << axis.cross(lever), axis;
  }
  return jacobian;
}

#define FLEXCOMP_CHAIN(Scalar, Joints)                                                        \
  template Kinematics<Scalar, Joints> forward_kinematics(const RobotModel<Scalar, Joints>&,   \
                                                         const JointVector<Scalar, Joints>&); \
  template Jacobian<Scalar, Joints> geometric_jacobian(const Kinematics<Scalar, Joints>&,     \
                                                       const Vector3<Scalar>&);
FLEXCOMP_INSTANTIATE_ARM(FLEXCOMP_CHAIN)

#define FLEXCOMP_POSE(Scalar)                                                       \
  template Matrix3<Scalar> axis_rotation(const Vector3<Scalar>&, Scalar);           \
  template Twist<Scalar> pose_difference(const Pose<Scalar>&, const Pose<Scalar>&); \
  template Pose<Scalar> displaced(const Pose<Scalar>&, const Twist<Scalar>&);
FLEXCOMP_POSE(float)
FLEXCOMP_POSE(double)

}  // namespace flexcomp
