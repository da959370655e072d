#pragma once

#include <array>

#include "flexcomp/chain.hpp"
#include "messages/messages.hpp"

namespace flexcomp {

/// Where a force sensor sits on an arm, and what hangs on it.
struct SensorMounting {
  /// Of the arm: joints' origins and axes, `tool` (the TCP in the last link's frame) and gravity.
  /// Springs and weights are not used.
  RobotModel<double, 6> arm;
  Pose<double> frame;  ///< the sensor's, in the last link's frame
  double mass = 0;     ///< kg, of all that hangs on the sensor
  Vector3<double> center_of_mass = Vector3<double>::Zero();  ///< m, its centre, last link's frame
};

/// The wrench on the tool at the TCP, robot base frame (N, N·m), from what the sensor is loaded
/// with in its own frame (N, N·m: the force and the moment that its tool side feels), while the arm
/// stands at `q` (rad). The weight of what hangs on the sensor is taken off; what it takes to
/// accelerate it is not. What is not finite gives what is not finite.
std::array<double, 6> wrench_at_tcp(const SensorMounting& mounting, const JointAngles& q,
                                    const std::array<double, 6>& load);

}  // namespace flexcomp
