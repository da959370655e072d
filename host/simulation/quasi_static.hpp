#pragma once

#include "flexcomp/compliance.hpp"

namespace flexcomp::simulation {

/// Where a loaded robot stands.
struct Equilibrium {
  Pose<double> tcp;               ///< base frame
  JointVector<double, 6> q_link;  ///< rad, motor angles plus wind-up
};

/// The flexible robot at rest with its motors at `q_motor` (rad), under a wrench on the tool at the
/// TCP (base frame) and, with gravity in the model, its weights.
///
/// All springs give as in the model, with every lever taken in the bent posture: the equilibrium
/// itself, not its linearisation, found by repeated substitution until no spring gives by more than
/// `tolerance` (rad, m) more. Throws InputError if the springs are so soft that there is no
/// equilibrium nearby.
Equilibrium settle(const RobotModel<double, 6>& model, const JointVector<double, 6>& q_motor,
                   const Wrench<double>& wrench, double tolerance = 1e-13);

/// The model with all of its springs `factor` times as soft.
RobotModel<double, 6> with_scaled_compliance(RobotModel<double, 6> model, double factor);

/// The model with stiff joints: what bends beyond encoders on the links.
RobotModel<double, 6> without_joint_springs(RobotModel<double, 6> model);

}  // namespace flexcomp::simulation
