#pragma once

#include <array>

#include "flexcomp/compliance.hpp"

namespace flexcomp::simulation {

/// What every spring of a robot has given, each in its own frame (m, rad); at first nothing.
struct Springs {
  Twist<double> base = Twist<double>::Zero();
  JointVector<double, 6> windup = JointVector<double, 6>::Zero();
  std::array<Twist<double>, 6> link;
  Twist<double> tool = Twist<double>::Zero();

  Springs() { link.fill(Twist<double>::Zero()); }
};

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

/// The same, sought from what the springs have given in a state nearby, like the one before; left
/// in them is what they give in this one.
Equilibrium settle_from(const RobotModel<double, 6>& model, const JointVector<double, 6>& q_motor,
                        const Wrench<double>& wrench, double tolerance, Springs* springs);

/// The model with all of its springs `factor` times as soft.
RobotModel<double, 6> with_scaled_compliance(RobotModel<double, 6> model, double factor);

/// The model with stiff joints: what bends beyond encoders on the links.
RobotModel<double, 6> without_joint_springs(RobotModel<double, 6> model);

}  // namespace flexcomp::simulation
