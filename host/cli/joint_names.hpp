#pragma once

#include <string>

#include "model/robot.hpp"

namespace flexcomp::cli {

/// A sentence about joints by their numbers, with their names in the URDF: "joint 3" becomes
/// "joint 3 (joint_a3)", "joints 1 and 6" becomes "joints 1 (joint_a1) and 6 (joint_a6)". Each is
/// named once, and not at all if its name is its number: "joint_3".
std::string with_joint_names(const std::string& sentence, const model::Robot& robot);

}  // namespace flexcomp::cli
