#pragma once

#include <filesystem>

#include "control/arc_design.hpp"
#include "model/robot.hpp"

namespace flexcomp::control {

/// Input of a design.
struct ArcRequest {
  simulation::FlexibleArm<6> arm;  ///< nominal
  ArmUncertainty uncertainty;
  MotionLimits motion;
  ArcBandwidth bandwidth;
};

/// Reads a design file (schema flexcomp/arc-design/1) for a robot:
///
///   arm:          # what robot.yaml does not say or the task changes, base to tip; may be left out
///     rotor_inertia: [6], viscous: [6], coulomb: [6], gravity: [3], payload: {mass, com: [3]}
///   motion:       {velocity, acceleration, jerk}      # rad/s, rad/s², rad/s³
///   uncertain:    # fuzzy numbers by name (see ArmUncertainty); what is left out is certain
///     payload: {triangular: [80, 150, 250]}           # also trapezoidal: [4], or
///     stiffness: {values: [0.8, 1, 1.1], degrees: [0, 1, 0]}
///   bandwidth:    # see ArcBandwidth; may be left out
///
/// Torque limits are the efforts of the URDF. Throws InputError naming file, line and key.
ArcRequest read_arc_request(const std::filesystem::path& file, const model::Robot& robot);

}  // namespace flexcomp::control
