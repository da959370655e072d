#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "flexcomp/types.hpp"

namespace flexcomp::model {

struct Robot;
class YamlMap;

/// A spindle with its cutter, or any other tool, as it hangs on the robot's flange. Everything is
/// in the frame of the robot's `tool_link`.
struct Tool {
  std::array<double, 3> xyz{};  ///< m, the TCP
  std::array<double, 3> rpy{};  ///< rad, the TCP frame by roll, pitch and yaw as in a URDF
  double mass = 0;              ///< kg
  std::array<double, 3> com{};  ///< m, centre of mass
  /// kg·m² about the centre of mass: ixx, ixy, ixz, iyy, iyz, izz, in a URDF's order.
  std::array<double, 6> inertia{};

  /// The TCP frame in that of `tool_link`.
  Pose<double> mounting() const;
};

/// Reads `{xyz: [3], rpy: [3], mass:, com: [3], inertia: [6]}`; `xyz` alone must be there. Throws
/// InputError with file, line and key for anything unknown or impossible.
Tool read_tool(const YamlMap& yaml);

/// Reads one tool of a file of named tools:
///
///     schema: flexcomp/tools/1
///     tools:
///       mill_16: {xyz: [0, 0, 0.25], mass: 12, com: [0, 0, 0.08]}
///
/// The name may be empty for a file of one tool. Throws InputError as `read_tool` does, and naming
/// the tools that there are for a name that is not among them.
Tool load_tool(const std::filesystem::path& file, const std::string& name);

/// Hangs a tool on a robot that has none: its TCP becomes the robot's, and its body part of the
/// last link's.
void attach(const Tool& tool, Robot* robot);

}  // namespace flexcomp::model
