#pragma once

#include <memory>

#include "flexcomp/model.hpp"

namespace flexcomp::bench {

/// The deflection of a six-joint robot as one computes it with Orocos KDL: its Jacobian, then
/// C w = J K⁻¹ Jᵀ w.
class KdlArm {
 public:
  explicit KdlArm(const RobotModel<double, 6>& robot);
  ~KdlArm();

  /// Twist of the TCP (m, rad; base frame) by a wrench there (N, N·m); q in rad.
  Twist<double> deflection(const JointVector<double, 6>& q, const Wrench<double>& wrench);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexcomp::bench
