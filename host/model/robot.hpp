#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/chain.hpp"
#include "model/tool.hpp"
#include "model/written_law.hpp"

namespace flexcomp::model {

/// Contributions of a joint to the torque balance, on the joint side of its gear; metres and
/// newtons in place of radians and newton metres for one that slides.
struct JointDynamics {
  double viscous = 0;        ///< N·m·s/rad
  double coulomb = 0;        ///< N·m
  double rotor_inertia = 0;  ///< kg·m²
  double backlash = 0;       ///< rad, full gap
  double effort = 0;         ///< N·m, largest torque
  double velocity = 0;       ///< rad/s, largest speed
};

/// Physics of a machine that the other keys cannot say, as a diagnosis found it or a person wrote
/// it.
struct LearnedEffect {
  std::string effect;  ///< of the diagnosis' vocabulary, such as transmission_ripple
  int joint = 0;       ///< from 1 on, 0 where the effect has no joint
  std::string form;    ///< which of its forms; empty where there is one
  std::map<std::string, double> parameters;  ///< SI
  std::optional<WrittenLaw> law;             ///< where the effect is `law`: the formula
  // NOLINTNEXTLINE(readability-redundant-member-init): one that was found leaves it out
  std::string place = {};  ///< file, line and key, for messages; empty if found
};

/// A robot as its two files describe it: a YAML file and the URDF it names.
struct Robot {
  std::string name;
  std::filesystem::path yaml;
  std::filesystem::path urdf;
  std::string base_link;
  std::string tool_link;
  std::optional<Tool> tool;           ///< on the flange, beside what the URDF holds; in `elastic`
  Chain elastic;                      ///< geometry, springs and weights
  PerJoint<std::string> joint_names;  ///< base to tip
  PerJoint<JointDynamics> dynamics;
  /// Speeds of the motors by those of the joints, in units of the joints: a coupled wrist's motor
  /// turns with the joint before its own as well. A motor's friction and rotor act by its own
  /// speed, and its torque on every joint that turns it. Recordings hold angles and torques of the
  /// joints.
  JointMatrix transmission;
  /// Inertia (kg·m²) of each moved link about its centre of mass, in the link frame; bodies fixed
  /// to the link are part of it.
  PerJoint<Matrix3<double>> link_inertia;
  /// °C at which the numbers hold; without it, that at which a recording begins.
  std::optional<double> reference_temperature;
  std::vector<LearnedEffect> effects;  ///< for simulations; the core does not know them

  int joints() const { return static_cast<int>(elastic.joints.size()); }

  /// Makes it a robot of so many joints about which nothing is known yet, each with its own motor.
  void set_joints(std::size_t count);
};

/// Do the motors tell the joints' angles?
bool is_transmission(const JointMatrix& transmission);

/// Reads a robot (schema flexcomp/robot/1). Throws InputError naming the file and the line, key,
/// link or joint for anything that is missing, unknown, misspelt, of the wrong type or impossible.
///
/// A compliance beyond what a robot can be (plausible_springs.hpp) is refused too.
///
/// Beside the schema's keys a joint may have `link_compliance`: six numbers, m/N (3) and rad/(N·m)
/// (3), of the link that the joint moves, diagonal in the link's frame, at the joint's origin; and
/// the robot `transmission`, a list of as many rows as joints of as many numbers, and `effects`, a
/// list of maps: `effect`, `joint` (from 1 on) and `form` where it has them, and the effect's
/// parameters by name. An effect `law` (written_law.hpp) has its formula beside them; what it says
/// is for others to check.
///
/// With `tool` (tool.hpp) the TCP is the tool's, and `tool_compliance` and `payload` are in its
/// frame. A tool that is given here takes the place of the file's.
Robot load_robot(const std::filesystem::path& file, const std::optional<Tool>& tool = {});

/// The core's model of a robot. Throws InputError naming the URDF and the first joint that is no
/// revolute one with limits, or how many there are, unless it has six such joints.
RobotModel<double, 6> six_axis_model(const Robot& robot);

/// Writes a robot's YAML file, whole or not at all; it names `robot.urdf` by a path relative to it.
///
/// Numbers are read back as they are; comments of a file that was there before are lost. What only
/// the URDF says (geometry, limits, masses) is not written. Throws InputError if the file cannot be
/// written, std::invalid_argument for a robot that `load_robot` would refuse.
void write_robot(const std::filesystem::path& file, const Robot& robot);

/// The text that `write_robot` would write to a file; throws as it does, but for what only writing
/// shows.
std::string robot_text(const std::filesystem::path& file, const Robot& robot);

}  // namespace flexcomp::model
