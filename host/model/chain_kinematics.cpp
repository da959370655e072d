#include "model/chain_kinematics.hpp"

namespace flexcomp::model {
namespace {

/// Adds to a TCP compliance the six springs at a frame of the chain, diagonal there.
void add_spring(const Pose<double>& frame, const DiagonalCompliance<double>& spring,
                const Vector3<double>& tcp, Compliance<double>* sum) {
  if (spring.isZero(0)) {
    return;
  }
  const Matrix3<double>& r = frame.rotation;
  const Vector3<double> arm = tcp - frame.position;
  for (Eigen::Index column = 0; column < 6; ++column) {
    const Wrench<double> unit = Wrench<double>::Unit(column);
    const Vector3<double> force = unit.head<3>();
    const Vector3<double> moment = unit.tail<3>() + arm.cross(force);
    const Vector3<double> shift = r * spring.head<3>().cwiseProduct(r.transpose() * force);
    const Vector3<double> turn = r * spring.tail<3>().cwiseProduct(r.transpose() * moment);
    sum->col(column).head<3>() += shift + turn.cross(arm);
    sum->col(column).tail<3>() += turn;
  }
}

}  // namespace

Pose<double> moved(const Pose<double>& frame, const ChainJoint& joint, double q) {
  if (joint.slides()) {
    return {frame.rotation, frame.position + frame.rotation * (q * joint.axis)};
  }
  return {frame.rotation * axis_rotation<double>(joint.axis, q), frame.position};
}

double joint_load(const ChainJoint& joint, const Vector3<double>& axis,
                  const Vector3<double>& force, const Vector3<double>& moment) {
  return axis.dot(joint.slides() ? force : moment);
}

ChainKinematics forward_kinematics(const Chain& chain, const JointValues& q) {
  ChainKinematics kinematics;
  Pose<double> pose;
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const ChainJoint& joint = chain.joint(i);
    pose = pose * joint.origin;
    kinematics.axes.push_back(pose.rotation * joint.axis);
    pose = moved(pose, joint, q[i]);
    kinematics.links.push_back(pose);
  }
  kinematics.tcp = pose * chain.tool;
  return kinematics;
}

ChainJacobian geometric_jacobian(const Chain& chain, const ChainKinematics& kinematics) {
  ChainJacobian jacobian(6, chain.size());
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const Vector3<double>& axis = kinematics.axes[i];
    auto column = jacobian.col(static_cast<Eigen::Index>(i));
    if (chain.joints[i].slides()) {
      column << axis, Vector3<double>::Zero();
    } else {
      const Vector3<double> lever = kinematics.tcp.position - kinematics.links[i].position;
      column << axis.cross(lever), axis;
    }
  }
  return jacobian;
}

JointValues wrench_torque(const ChainJacobian& jacobian, const Wrench<double>& wrench) {
  return jacobian.transpose().lazyProduct(wrench);
}

JointValues weight_torque(const Chain& chain, const ChainKinematics& kinematics) {
  Vector3<double> force = Vector3<double>::Zero();
  Vector3<double> moment_at_base = Vector3<double>::Zero();
  const auto add = [&](double mass, const Vector3<double>& center) {
    const Vector3<double> weight = mass * chain.gravity;
    force += weight;
    moment_at_base += center.cross(weight);
  };
  add(chain.payload_mass, kinematics.tcp.position + kinematics.tcp.rotation * chain.payload_center);
  JointValues load(chain.size());
  for (std::size_t i = chain.joints.size(); i-- > 0;) {
    const ChainJoint& joint = chain.joints[i];
    const Pose<double>& link = kinematics.links[i];
    add(joint.mass, link.position + link.rotation * joint.center_of_mass);
    load[static_cast<Eigen::Index>(i)] =
        joint_load(joint, kinematics.axes[i], force, moment_at_base - link.position.cross(force));
  }
  return load;
}

JointValues joint_windup(const Chain& chain, const JointValues& load) {
  JointValues windup(chain.size());
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const ChainJoint& joint = chain.joint(i);
    windup[i] = (joint.compliance + joint.cubic_compliance * load[i] * load[i]) * load[i];
  }
  return windup;
}

Compliance<double> tcp_compliance(const Chain& chain, const ChainKinematics& kinematics) {
  const ChainJacobian jacobian = geometric_jacobian(chain, kinematics);
  ChainJacobian weighted = jacobian;
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    weighted.col(i) *= chain.joint(i).compliance;
  }
  const Vector3<double>& tcp = kinematics.tcp.position;
  Compliance<double> structure = Compliance<double>::Zero();
  add_spring(kinematics.tcp, chain.tool_compliance, tcp, &structure);
  for (std::size_t i = chain.joints.size(); i-- > 0;) {
    add_spring(kinematics.links[i], chain.joints[i].link_compliance, tcp, &structure);
  }
  add_spring(Pose<double>{}, chain.base_compliance, tcp, &structure);
  return weighted.lazyProduct(jacobian.transpose()) + structure;
}

}  // namespace flexcomp::model
