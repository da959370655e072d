#pragma once

#include <functional>

#include "simulation/machine.hpp"

/// Parts that the terms of laws are made of.
namespace flexcomp::effects {

using simulation::Prediction;
using simulation::Simulation;

/// Adds an angle (n, rad) to a joint, the same for the TCP and for the link encoder.
void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     Prediction* prediction);

/// Adds an angle driven by the load on a joint: by the load at rest for the TCP, by the load with
/// inertia for the link encoder.
void add_load_driven(const Simulation& simulation, int joint,
                     const std::function<Eigen::VectorXd(const Eigen::VectorXd& load)>& angle,
                     Prediction* prediction);

/// N·m (N of a joint that slides). A joint that bears less presses on no flank of its gear, so that
/// its play follows the motion. Measured on recordings of tools/score-diagnosis (seeds from 500): a
/// joint 6 without a load bears up to 0.05 N·m, every other joint 2 N·m or more.
constexpr double kLeastFlankLoad = 1;

/// Adds a torque (n, N·m) to a joint's drive.
void add_torque(int joint, const Eigen::VectorXd& torque, Prediction* prediction);

/// Alters what is shown of a joint's torque (n, N·m), or of every joint's (joint 0).
void alter_shown_torque(int joint, const std::function<void(Eigen::Ref<Eigen::VectorXd>)>& alter,
                        Prediction* prediction);

/// Direction in which a joint moves (n): 1, −1, or 0 where it stands.
Eigen::ArrayXd directions(const Simulation& simulation, int joint);

/// a sin(order·q) + b cos(order·q) along a joint's angle; values: a, b, order.
Eigen::VectorXd ripple(const Simulation& simulation, int joint, const std::vector<double>& values);

}  // namespace flexcomp::effects
