#pragma once

#include "flexcomp/model.hpp"

namespace flexcomp::study {

/// Tells poses that a robot cannot reach whatever its wrist does, without looking for joint angles:
/// that search is long where there are none.
class WristReach {
 public:
  /// For robots whose last three axes meet in a point, on an arm as `planar_arm` takes it that
  /// joint 1 turns about z; of others every pose counts as in reach. `limits`: heed those of
  /// joint 3.
  WristReach(const RobotModel<double, 6>& model, bool limits);

  /// False only if no angles of joints 1 to 3 take the wrist where this pose of the TCP needs it.
  bool may_hold(const Pose<double>& tcp) const;

 private:
  bool is_known_ = false;
  Vector3<double> wrist_ = Vector3<double>::Zero();  ///< its centre, TCP frame
  double shoulder_out_ = 0;                          ///< m, axis of joint 2 from that of joint 1
  double shoulder_up_ = 0;                           ///< m, over the base frame
  double nearest_ = 0;                               ///< m, wrist from the axis of joint 2
  double farthest_ = 0;
};

}  // namespace flexcomp::study
