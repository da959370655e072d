#pragma once

#include "model/robot.hpp"

namespace flexcomp::simulation {

/// Rigid-body inverse dynamics of a robot by recursive Newton–Euler (Luh, Walker and Paul 1980):
/// torque (N·m) about each joint for angles (rad), velocities (rad/s) and accelerations (rad/s²),
/// weight included, without friction, rotors and external wrench.
JointVector<double, 6> inverse_dynamics(const model::Robot& robot, const JointVector<double, 6>& q,
                                        const JointVector<double, 6>& velocity,
                                        const JointVector<double, 6>& acceleration);

}  // namespace flexcomp::simulation
