#include "pinocchio_arm.hpp"

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/multibody.hpp>

namespace flexcomp::bench {
namespace {

pinocchio::JointModel joint_about(const Vector3<double>& axis) {
  if (axis == Vector3<double>::UnitX()) {
    return pinocchio::JointModelRX();
  }
  if (axis == Vector3<double>::UnitY()) {
    return pinocchio::JointModelRY();
  }
  if (axis == Vector3<double>::UnitZ()) {
    return pinocchio::JointModelRZ();
  }
  return pinocchio::JointModelRevoluteUnaligned(axis);
}

pinocchio::Model model_of(const RobotModel<double, 6>& robot) {
  pinocchio::Model model;
  pinocchio::JointIndex last = 0;
  for (const Joint<double>& joint : robot.joints) {
    last = model.addJoint(last, joint_about(joint.axis),
                          pinocchio::SE3(joint.origin.rotation, joint.origin.position),
                          "joint_" + std::to_string(last + 1));
  }
  return model;
}

}  // namespace

class PinocchioArm::Implementation {
 public:
  Implementation(const RobotModel<double, 6>& robot, int joint)
      : model_(model_of(robot)),
        tcp_(model_.addFrame(
            pinocchio::Frame("tcp", 6, 0, pinocchio::SE3(robot.tool.rotation, robot.tool.position),
                             pinocchio::OP_FRAME))),
        data_(model_),
        joint_(static_cast<pinocchio::JointIndex>(joint)) {
    for (std::size_t i = 0; i < 6; ++i) {
      compliance_[static_cast<Eigen::Index>(i)] = robot.joints[i].compliance;
    }
    jacobian_.setZero();
  }

  Twist<double> deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench) {
    pinocchio::computeJointJacobians(model_, data_, q);
    pinocchio::getJointJacobian(model_, data_, joint_, pinocchio::LOCAL_WORLD_ALIGNED, jacobian_);
    return deflection_by(wrench);
  }

  Twist<double> tcp_deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench) {
    pinocchio::computeJointJacobians(model_, data_, q);
    pinocchio::getFrameJacobian(model_, data_, tcp_, pinocchio::LOCAL_WORLD_ALIGNED, jacobian_);
    return deflection_by(wrench);
  }

 private:
  Twist<double> deflection_by(const Wrench<double>& wrench) const {
    return jacobian_ * compliance_.cwiseProduct(jacobian_.transpose() * wrench);
  }

  pinocchio::Model model_;
  pinocchio::FrameIndex tcp_;
  pinocchio::Data data_;
  JointVector<double, 6> compliance_;
  pinocchio::JointIndex joint_;
  Eigen::Matrix<double, 6, 6> jacobian_;
};

PinocchioArm::PinocchioArm(const RobotModel<double, 6>& robot, int joint)
    : implementation_(std::make_unique<Implementation>(robot, joint)) {}

PinocchioArm::~PinocchioArm() = default;

Twist<double> PinocchioArm::deflection(const JointVector<double, 6>& q,
                                       const Wrench<double>& wrench) {
  return implementation_->deflection(q, wrench);
}

Twist<double> PinocchioArm::tcp_deflection(const JointVector<double, 6>& q,
                                           const Wrench<double>& wrench) {
  return implementation_->tcp_deflection(q, wrench);
}

}  // namespace flexcomp::bench
