#pragma once

#include "flexcomp/chain.hpp"
#include "model/chain.hpp"

/// The core's computations for six revolute joints, for any chain (same methods, same names).
namespace flexcomp::model {

/// Where everything is in one posture; all in the base frame.
struct ChainKinematics {
  PerJoint<Pose<double>> links;    ///< frame of the link that joint i moves
  PerJoint<Vector3<double>> axes;  ///< unit axis of joint i
  Pose<double> tcp;
};

/// A frame moved by its joint: turned about the joint's axis, or shifted along it, by `q`.
Pose<double> moved(const Pose<double>& frame, const ChainJoint& joint, double q);

/// Load of a joint's spring and drive: of all that acts beyond it, the moment about its axis or the
/// force along it. `force` and `moment` act at the joint's origin; `axis` in the same frame.
double joint_load(const ChainJoint& joint, const Vector3<double>& axis,
                  const Vector3<double>& force, const Vector3<double>& moment);

ChainKinematics forward_kinematics(const Chain& chain, const JointValues& q);

/// Geometric Jacobian of the TCP, rows [linear; angular], base frame: [z × (tcp − o); z] of a joint
/// that turns, [z; 0] of one that slides.
ChainJacobian geometric_jacobian(const Chain& chain, const ChainKinematics& kinematics);

/// Load on each joint from a wrench on the tool: Jᵀ w.
JointValues wrench_torque(const ChainJacobian& jacobian, const Wrench<double>& wrench);

/// Load on each joint from the weight of everything beyond it, payload included.
JointValues weight_torque(const Chain& chain, const ChainKinematics& kinematics);

/// Wind-up of each joint's spring under its load: c1 τ + c3 τ³.
JointValues joint_windup(const Chain& chain, const JointValues& load);

/// Linear compliance at the TCP, base frame: C = J K⁻¹ Jᵀ over the joint springs plus the base,
/// link and tool springs. Klimchik et al. (2017), virtual joint model.
Compliance<double> tcp_compliance(const Chain& chain, const ChainKinematics& kinematics);

}  // namespace flexcomp::model
