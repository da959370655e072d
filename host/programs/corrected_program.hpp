#pragma once

#include <optional>
#include <vector>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// The tool of the robot's model, in the frame of its last link.
struct CarriedTool {
  Pose<double> tcp;
  double mass = 0;                                   ///< kg; zero where nobody knows
  Vector3<double> center = Vector3<double>::Zero();  ///< of mass, m
};

/// A program with what takes the place of each of its motions.
struct CorrectedProgram {
  Program source;
  Pose<double> frame;  ///< the work frame in the robot base frame
  /// A motion or more for each of the source's, one after the other; ends in the work frame.
  std::vector<std::vector<Motion>> in_place;
  double largest_correction = 0;    ///< m, at the TCP; zero where the program is only written anew
  std::optional<CarriedTool> tool;  ///< nothing where the model's TCP is its last link's
};

/// The program in a format: in the source's own with all that does not move left as it is, in
/// another with the lines that do not move as comments.
///
/// KRL and RAPID have whole orientations and arcs; points that were added are passed without a stop
/// (C_DIS, z0). G-code has arcs as short lines, and orientations (A, B, C) where the source has
/// some: else the tip alone is corrected. CSV is written anew, with orientations as quaternions.
std::string text_of(const CorrectedProgram& program, Format format, const std::string& name);

}  // namespace flexcomp::programs
