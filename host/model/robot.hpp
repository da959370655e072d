#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "flexcomp/model.hpp"

namespace flexcomp::model {

/// What a joint adds to the torque balance, on the joint side of its gear.
struct JointDynamics {
  double viscous = 0;        ///< N·m·s/rad
  double coulomb = 0;        ///< N·m
  double rotor_inertia = 0;  ///< kg·m²
  double backlash = 0;       ///< rad, full gap
  double effort = 0;         ///< N·m, largest torque
  double velocity = 0;       ///< rad/s, largest speed
};

/// A robot as its two files describe it: a YAML file and the URDF it names.
struct Robot {
  std::string name;
  std::filesystem::path yaml;
  std::filesystem::path urdf;
  std::string base_link;
  std::string tool_link;
  std::array<std::string, 6> joint_names;  ///< base to tip
  RobotModel<double, 6> elastic;           ///< geometry, springs and weights: what the core needs
  std::array<JointDynamics, 6> dynamics;
  /// Inertia (kg·m²) of each moved link about its centre of mass, in the link frame; bodies fixed
  /// to the link are part of it.
  std::array<Matrix3<double>, 6> link_inertia;
};

/// Reads a robot (schema flexcomp/robot/1). Throws InputError naming the file and the line, key,
/// link or joint for anything that is missing, unknown, misspelt, of the wrong type or impossible.
///
/// Beside the schema's keys a joint may have `link_compliance`: six numbers, m/N (3) and rad/(N·m)
/// (3), of the link that the joint moves, diagonal in the link's frame, at the joint's origin.
Robot load_robot(const std::filesystem::path& file);

/// Writes a robot's YAML file, whole or not at all; it names `robot.urdf` by a path relative to it.
///
/// Numbers are read back as they are; comments of a file that was there before are lost. What only
/// the URDF says (geometry, limits, masses) is not written. Throws InputError if the file cannot be
/// written, std::invalid_argument for a robot that `load_robot` would refuse.
void write_robot(const std::filesystem::path& file, const Robot& robot);

}  // namespace flexcomp::model
