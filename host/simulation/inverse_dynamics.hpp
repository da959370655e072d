#pragma once

#include "model/robot.hpp"

namespace flexcomp::simulation {

using model::JointValues;

/// Rigid-body inverse dynamics of a robot by recursive Newton–Euler (Luh, Walker and Paul 1980):
/// torque (N·m) about each joint, or force (N) along it, for angles (rad, m), velocities and
/// accelerations, weight included, without friction, rotors and external wrench.
JointValues inverse_dynamics(const model::Robot& robot, const JointValues& q,
                             const JointValues& velocity, const JointValues& acceleration);

}  // namespace flexcomp::simulation
