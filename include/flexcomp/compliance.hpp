#pragma once

/// @file
/// How a robot gives way under wrench and weight, and the correction against it.

#include "flexcomp/chain.hpp"

namespace flexcomp {

/// Torque on each joint (N·m) from a wrench on the tool: Jᵀ w.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> wrench_torque(const Jacobian<Scalar, Joints>& jacobian,
                                          const Wrench<Scalar>& wrench) {
  return jacobian.transpose().lazyProduct(wrench);
}

/// Torque on each joint (N·m) from the weight of everything beyond it, payload included.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> weight_torque(const RobotModel<Scalar, Joints>& model,
                                          const Kinematics<Scalar, Joints>& kinematics);

/// Wind-up of each joint spring (rad) under its torque: c1 τ + c3 τ³.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> joint_windup(const RobotModel<Scalar, Joints>& model,
                                         const JointVector<Scalar, Joints>& torque);

/// Compliance of the base, link and tool springs seen at the TCP, base frame.
template <typename Scalar, int Joints>
Compliance<Scalar> structure_compliance(const RobotModel<Scalar, Joints>& model,
                                        const Kinematics<Scalar, Joints>& kinematics);

/// Twist of the TCP from the weights acting on the base, link and tool springs.
template <typename Scalar, int Joints>
Twist<Scalar> structure_weight_deflection(const RobotModel<Scalar, Joints>& model,
                                          const Kinematics<Scalar, Joints>& kinematics);

/// Linear compliance at the TCP, base frame: C = J K⁻¹ Jᵀ over the joint springs plus the base,
/// link and tool springs. Klimchik et al. (2017), virtual joint model.
template <typename Scalar, int Joints>
Compliance<Scalar> tcp_compliance(const RobotModel<Scalar, Joints>& model,
                                  const Kinematics<Scalar, Joints>& kinematics);

/// How the robot gives way at one posture.
template <typename Scalar, int Joints>
struct Deflection {
  Twist<Scalar> tcp;                   ///< displacement of the TCP, base frame
  JointVector<Scalar, Joints> windup;  ///< part of it taken by the joint springs, rad
};

/// Deflection under a wrench and, with gravity in the model, under weight, with all levers taken at
/// the joint angles `q` of the links.
///
/// Exact for joint springs if `q` are the angles the loaded links have; if `q` are the motor angles
/// it is the first-order prediction, off by about |deflection|²/reach.
template <typename Scalar, int Joints>
Deflection<Scalar, Joints> deflection(const RobotModel<Scalar, Joints>& model,
                                      const JointVector<Scalar, Joints>& q,
                                      const Wrench<Scalar>& wrench);

/// Joint motion that moves the TCP by `twist`, by damped least squares: exact away from
/// singularities; at one (wrist axes 4 and 6 in line) the reachable part of the twist.
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> joint_motion(const Jacobian<Scalar, Joints>& jacobian,
                                         const Twist<Scalar>& twist);

/// Correction to add to the setpoint `q` (rad) so that the loaded TCP stands where the unloaded one
/// would: position and orientation.
///
/// Wanted are motor angles m with link angles q under load. The joint springs carry the torque τ of
/// the loaded posture, which is the wanted one, so m = q − windup(τ(q)): exact in one step, without
/// inverting J, at singularities too. Base, link and tool springs displace the TCP by d; their part
/// is −J⁺ d, one Newton step, with a remainder of about |d|·|deflection|/reach (1 mm of base
/// deflection of a 3 m robot that gives 2 mm: below 1 µm).
template <typename Scalar, int Joints>
JointVector<Scalar, Joints> setpoint_correction(const RobotModel<Scalar, Joints>& model,
                                                const JointVector<Scalar, Joints>& q,
                                                const Wrench<Scalar>& wrench);

}  // namespace flexcomp
