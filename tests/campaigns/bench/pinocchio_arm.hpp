#pragma once

#include <memory>

#include "flexcomp/model.hpp"

namespace flexcomp::bench {

/// The deflection of a six-joint robot as one computes it with Pinocchio: its Jacobian, then
/// C w = J K⁻¹ Jᵀ w.
class PinocchioArm {
 public:
  /// `joint`: whose origin takes the wrench, from 1. Joints become what Pinocchio's own reader of
  /// URDF makes of them.
  PinocchioArm(const RobotModel<double, 6>& robot, int joint);
  ~PinocchioArm();

  /// Twist at the joint's origin (m, rad; base frame) by a wrench there (N, N·m); q in rad.
  Twist<double> deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench);

  /// The same of the TCP, by a wrench there.
  Twist<double> tcp_deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexcomp::bench
