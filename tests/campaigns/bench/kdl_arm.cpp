#include "kdl_arm.hpp"

#include <kdl/chainjnttojacsolver.hpp>

#include "model/kdl.hpp"

namespace flexcomp::bench {
namespace {

/// Seven frames, six segments: the tool is part of the last.
KDL::Chain chain_of(const RobotModel<double, 6>& robot) {
  KDL::Chain chain;
  for (std::size_t i = 0; i < 6; ++i) {
    const KDL::Frame origin = model::to_kdl(robot.joints[i].origin);
    const KDL::Joint joint(origin.p, origin.M * model::to_kdl(robot.joints[i].axis),
                           KDL::Joint::RotAxis);
    chain.addSegment(KDL::Segment(joint, i < 5 ? origin : origin * model::to_kdl(robot.tool)));
  }
  return chain;
}

}  // namespace

class KdlArm::Implementation {
 public:
  explicit Implementation(const RobotModel<double, 6>& robot)
      : chain_(chain_of(robot)), solver_(chain_), angles_(6), jacobian_(6) {
    for (std::size_t i = 0; i < 6; ++i) {
      compliance_[static_cast<Eigen::Index>(i)] = robot.joints[i].compliance;
    }
  }

  Twist<double> deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench) {
    angles_.data = q;
    solver_.JntToJac(angles_, jacobian_);
    // A view of known size: products of KDL's own, whose width is not known, would allocate.
    const Eigen::Map<const Eigen::Matrix<double, 6, 6>> jacobian(jacobian_.data.data());
    return jacobian * compliance_.cwiseProduct(jacobian.transpose() * wrench);
  }

 private:
  KDL::Chain chain_;
  KDL::ChainJntToJacSolver solver_;
  KDL::JntArray angles_;
  KDL::Jacobian jacobian_;
  JointVector<double, 6> compliance_;
};

KdlArm::KdlArm(const RobotModel<double, 6>& robot)
    : implementation_(std::make_unique<Implementation>(robot)) {}

KdlArm::~KdlArm() = default;

Twist<double> KdlArm::deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench) {
  return implementation_->deflection(q, wrench);
}

}  // namespace flexcomp::bench
