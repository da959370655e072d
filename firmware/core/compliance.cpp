#include "flexcomp/compliance.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "instantiate.hpp"

namespace flexcomp {
namespace {

/// The weights beyond a cut through the chain, gathered from the tip inwards.
template <typename Scalar>
struct WeightBeyond {
  Vector3<Scalar> force = Vector3<Scalar>::Zero();
  Vector3<Scalar> moment_at_base = Vector3<Scalar>::Zero();

  void add(Scalar mass, const Vector3<Scalar>& center, const Vector3<Scalar>& gravity) {
    const Vector3<Scalar> weight = mass * gravity;
    force += weight;
    moment_at_base += center.cross(weight);
  }

  Vector3<Scalar> moment_at(const Vector3<Scalar>& point) const {
    return moment_at_base - point.cross(force);
  }
};

/// Six springs in series at one frame of the chain, seen from the TCP.
template <typename Scalar>
struct StructureSpring {
  Pose<Scalar> frame;
  DiagonalCompliance<Scalar> compliance;

  Twist<Scalar> tcp_twist(const Vector3<Scalar>& force, const Vector3<Scalar>& moment,
                          const Vector3<Scalar>& tcp) const {
    const Matrix3<Scalar>& r = frame.rotation;
    const Vector3<Scalar> shift =
        r * compliance.template head<3>().cwiseProduct(r.transpose() * force);
    const Vector3<Scalar> turn =
        r * compliance.template tail<3>().cwiseProduct(r.transpose() * moment);
    Twist<Scalar> twist;
    twist << shift + turn.cross(tcp - frame.position), turn;
    return twist;
  }
};

/// Calls `visit(spring, weight beyond it)` for every base, link and tool spring, tip to base.
template <typename Scalar, int Joints, typename Visitor>
void for_each_structure_spring(const RobotModel<Scalar, Joints>& model,
                               const Kinematics<Scalar, Joints>& kinematics, Visitor visit) {
  WeightBeyond<Scalar> beyond;
  beyond.add(model.payload_mass,
             kinematics.tcp.position + kinematics.tcp.rotation * model.payload_center,
             model.gravity);
  visit(StructureSpring<Scalar>{kinematics.tcp, model.tool_compliance}, beyond);
  for (std::size_t i = Joints; i-- > 0;) {
    const Joint<Scalar>& joint = model.joints[i];
    const Pose<Scalar>& link = kinematics.links[i];
    beyond.add(joint.mass, link.position + link.rotation * joint.center_of_mass, model.gravity);
    visit(StructureSpring<Scalar>{link, joint.link_compliance}, beyond);
  }
  visit(StructureSpring<Scalar>{Pose<Scalar>{}, model.base_compliance}, beyond);
}

}  // namespace

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> weight_torque(const RobotModel<Scalar, Joints>& model,
                                          const Kinematics<Scalar, Joints>& kinematics) {
  WeightBeyond<Scalar> beyond;
  beyond.add(model.payload_mass,
             kinematics.tcp.position + kinematics.tcp.rotation * model.payload_center,
             model.gravity);
  JointVector<Scalar, Joints> torque;
  for (std::size_t i = Joints; i-- > 0;) {
    const Joint<Scalar>& joint = model.joints[i];
    const Pose<Scalar>& link = kinematics.links[i];
    beyond.add(joint.mass, link.position + link.rotation * joint.center_of_mass, model.gravity);
    torque[static_cast<Eigen::Index>(i)] = kinematics.axes[i].dot(beyond.moment_at(link.position));
  }
  return torque;
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> joint_windup(const RobotModel<Scalar, Joints>& model,
                                         const JointVector<Scalar, Joints>& torque) {
  JointVector<Scalar, Joints> windup;
  for (std::size_t i = 0; i < Joints; ++i) {
    const Scalar t = torque[static_cast<Eigen::Index>(i)];
    const Joint<Scalar>& joint = model.joints[i];
    windup[static_cast<Eigen::Index>(i)] = (joint.compliance + joint.cubic_compliance * t * t) * t;
  }
  return windup;
}

template <typename Scalar, int Joints>
Compliance<Scalar> structure_compliance(const RobotModel<Scalar, Joints>& model,
                                        const Kinematics<Scalar, Joints>& kinematics) {
  const Vector3<Scalar>& tcp = kinematics.tcp.position;
  Compliance<Scalar> sum = Compliance<Scalar>::Zero();
  for_each_structure_spring(
      model, kinematics,
      [&](const StructureSpring<Scalar>& spring, const WeightBeyond<Scalar>& /*beyond*/) {
        if (spring.compliance.isZero(Scalar(0))) {
          return;
        }
        for (Eigen::Index column = 0; column < 6; ++column) {
          const Wrench<Scalar> unit = Wrench<Scalar>::Unit(column);
          const Vector3<Scalar> force = unit.template head<3>();
          const Vector3<Scalar> moment =
              unit.template tail<3>() + (tcp - spring.frame.position).cross(force);
          sum.col(column) += spring.tcp_twist(force, moment, tcp);
        }
      });
  return sum;
}

template <typename Scalar, int Joints>
Twist<Scalar> structure_weight_deflection(const RobotModel<Scalar, Joints>& model,
                                          const Kinematics<Scalar, Joints>& kinematics) {
  const Vector3<Scalar>& tcp = kinematics.tcp.position;
  Twist<Scalar> sum = Twist<Scalar>::Zero();
  for_each_structure_spring(
      model, kinematics,
      [&](const StructureSpring<Scalar>& spring, const WeightBeyond<Scalar>& beyond) {
        sum += spring.tcp_twist(beyond.force, beyond.moment_at(spring.frame.position), tcp);
      });
  return sum;
}

template <typename Scalar, int Joints>
Compliance<Scalar> tcp_compliance(const RobotModel<Scalar, Joints>& model,
                                  const Kinematics<Scalar, Joints>& kinematics) {
  const Jacobian<Scalar, Joints> jacobian = geometric_jacobian<Scalar, Joints>(kinematics);
  JointVector<Scalar, Joints> springs;
  for (std::size_t i = 0; i < Joints; ++i) {
    springs[static_cast<Eigen::Index>(i)] = model.joints[i].compliance;
  }
  const Jacobian<Scalar, Joints> weighted = jacobian * springs.asDiagonal();
  return weighted.lazyProduct(jacobian.transpose()) + structure_compliance(model, kinematics);
}

template <typename Scalar, int Joints>
Deflection<Scalar, Joints> deflection(const RobotModel<Scalar, Joints>& model,
                                      const JointVector<Scalar, Joints>& q,
                                      const Wrench<Scalar>& wrench) {
  const Kinematics<Scalar, Joints> kinematics = forward_kinematics(model, q);
  const Jacobian<Scalar, Joints> jacobian = geometric_jacobian<Scalar, Joints>(kinematics);
  const JointVector<Scalar, Joints> torque =
      wrench_torque<Scalar, Joints>(jacobian, wrench) + weight_torque(model, kinematics);
  Deflection<Scalar, Joints> result;
  result.windup = joint_windup(model, torque);
  result.tcp = jacobian.lazyProduct(result.windup);
  if (has_structure_springs(model)) {
    result.tcp += structure_compliance(model, kinematics).lazyProduct(wrench);
    result.tcp += structure_weight_deflection(model, kinematics);
  }
  return result;
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> joint_motion(const Jacobian<Scalar, Joints>& jacobian,
                                         const Twist<Scalar>& twist) {
  // Damping grows from zero as the manipulability √det(J Jᵀ) falls below a threshold, so that the
  // solution is exact elsewhere (Nakamura and Hanafusa 1986). The threshold is met by a six-axis
  // robot of 2.5 m reach with axes 4 and 6 about 4° from in line.
  constexpr Scalar kThreshold = Scalar(0.1);
  constexpr Scalar kLargestDamping = Scalar(0.05);
  Compliance<Scalar> gram = jacobian.lazyProduct(jacobian.transpose());
  const Eigen::LDLT<Compliance<Scalar>> exact(gram);
  const Scalar determinant = exact.vectorD().prod();
  const Scalar manipulability = std::sqrt(determinant > Scalar(0) ? determinant : Scalar(0));
  if (manipulability >= kThreshold) {
    return jacobian.transpose().lazyProduct(exact.solve(twist));
  }
  const Scalar damping = kLargestDamping * (Scalar(1) - manipulability / kThreshold);
  gram.diagonal().array() += damping * damping;
  const Eigen::LDLT<Compliance<Scalar>> damped(gram);
  return jacobian.transpose().lazyProduct(damped.solve(twist));
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> setpoint_correction(const RobotModel<Scalar, Joints>& model,
                                                const JointVector<Scalar, Joints>& q,
                                                const Wrench<Scalar>& wrench) {
  const Deflection<Scalar, Joints> bent = deflection(model, q, wrench);
  if (!has_structure_springs(model)) {
    return -bent.windup;
  }
  const Jacobian<Scalar, Joints> jacobian =
      geometric_jacobian<Scalar, Joints>(forward_kinematics(model, q));
  const Twist<Scalar> structure = bent.tcp - jacobian.lazyProduct(bent.windup);
  return -bent.windup - joint_motion<Scalar, Joints>(jacobian, structure);
}

#define FLEXCOMP_COMPLIANCE(Scalar, Joints)                                                    \
  template JointVector<Scalar, Joints> weight_torque(const RobotModel<Scalar, Joints>&,        \
                                                     const Kinematics<Scalar, Joints>&);       \
  template JointVector<Scalar, Joints> joint_windup(const RobotModel<Scalar, Joints>&,         \
                                                    const JointVector<Scalar, Joints>&);       \
  template Compliance<Scalar> structure_compliance(const RobotModel<Scalar, Joints>&,          \
                                                   const Kinematics<Scalar, Joints>&);         \
  template Twist<Scalar> structure_weight_deflection(const RobotModel<Scalar, Joints>&,        \
                                                     const Kinematics<Scalar, Joints>&);       \
  template Compliance<Scalar> tcp_compliance(const RobotModel<Scalar, Joints>&,                \
                                             const Kinematics<Scalar, Joints>&);               \
  template Deflection<Scalar, Joints> deflection(const RobotModel<Scalar, Joints>&,            \
                                                 const JointVector<Scalar, Joints>&,           \
                                                 const Wrench<Scalar>&);                       \
  template JointVector<Scalar, Joints> joint_motion(const Jacobian<Scalar, Joints>&,           \
                                                    const Twist<Scalar>&);                     \
  template JointVector<Scalar, Joints> setpoint_correction(const RobotModel<Scalar, Joints>&,  \
                                                           const JointVector<Scalar, Joints>&, \
                                                           const Wrench<Scalar>&);
FLEXCOMP_INSTANTIATE_ARM(FLEXCOMP_COMPLIANCE)

}  // namespace flexcomp
