#pragma once

#include <fmt/format.h>

#include "diagnosis/effect.hpp"
#include "simulation/history.hpp"

namespace flexcomp::diagnosis {

std::vector<Hypothesis> backlash(const Observations& observations);
std::vector<Hypothesis> base_compliance(const Observations& observations);
std::vector<Hypothesis> base_frame(const Observations& observations);
std::vector<Hypothesis> coulomb_friction(const Observations& observations);
std::vector<Hypothesis> friction_hysteresis(const Observations& observations);
std::vector<Hypothesis> gravity_compensator(const Observations& observations);
std::vector<Hypothesis> hysteresis(const Observations& observations);
std::vector<Hypothesis> joint_axis(const Observations& observations);
std::vector<Hypothesis> joint_offset(const Observations& observations);
std::vector<Hypothesis> joint_stiffness(const Observations& observations);
std::vector<Hypothesis> link_flexibility(const Observations& observations);
std::vector<Hypothesis> link_length(const Observations& observations);
std::vector<Hypothesis> link_mass(const Observations& observations);
std::vector<Hypothesis> nonlinear_stiffness(const Observations& observations);
std::vector<Hypothesis> payload(const Observations& observations);
std::vector<Hypothesis> resonance(const Observations& observations);
std::vector<Hypothesis> rotor_inertia(const Observations& observations);
std::vector<Hypothesis> servo_lag(const Observations& observations);
std::vector<Hypothesis> stribeck_friction(const Observations& observations);
std::vector<Hypothesis> tcp_offset(const Observations& observations);
std::vector<Hypothesis> thermal_drift(const Observations& observations);
std::vector<Hypothesis> time_offset(const Observations& observations);
std::vector<Hypothesis> tool_compliance(const Observations& observations);
std::vector<Hypothesis> torque_offset(const Observations& observations);
std::vector<Hypothesis> torque_ripple(const Observations& observations);
std::vector<Hypothesis> transmission_ripple(const Observations& observations);
std::vector<Hypothesis> viscous_friction(const Observations& observations);
std::vector<Hypothesis> wrench_bias(const Observations& observations);
std::vector<Hypothesis> wrench_frame(const Observations& observations);
std::vector<Hypothesis> wrench_scale(const Observations& observations);

/// Can wind-up and position errors of the joints be seen, at the TCP or by link encoders?
bool sees_angles(const Observations& observations);

/// Adds an angle (rad) to a joint, the same for the TCP and for the link encoder.
void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     Prediction* prediction);

/// Adds a series driven by the load on a joint, taken of the load at rest for the TCP and of the
/// load with inertia for the link encoder.
void add_load_driven(const Simulation& simulation, int joint,
                     const std::function<Eigen::VectorXd(const Eigen::VectorXd& load)>& series,
                     Prediction* prediction);

/// a sin(order·q) + b cos(order·q) along a joint's angle; values: a, b, order.
Eigen::VectorXd ripple(const Simulation& simulation, int joint, const Values& values);

/// Adds a torque (n, N·m) of a joint's drive.
void add_torque(int joint, const Eigen::VectorXd& torque, Prediction* prediction);

/// What a force sensor's reading stands for, tool frame, by an effect's values.
using SensorModel = std::function<Wrench<double>(const Values&, const Wrench<double>& read)>;

/// Completes a hypothesis about the force sensor.
void set_sensor(SensorModel truth, Hypothesis* hypothesis);

/// Orders (periods a turn) whose sinusoids of a joint's angle explain most, the best first; none
/// where fewer than two periods of any would be seen.
std::vector<Values> ripple_orders(const Observations& observations, int joint,
                                  const std::vector<JointResidual>& residual);

}  // namespace flexcomp::diagnosis
