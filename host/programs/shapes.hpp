#pragma once

#include "programs/program.hpp"

namespace flexcomp::programs {

/// A rectangular pocket milled flat, level by level, each from the middle outwards in growing
/// rectangles that run anticlockwise; surface at z = 0 of the work frame, its middle at the origin.
struct Pocket {
  double length = 0.2;       ///< m, along x
  double width = 0.1;        ///< m, along y
  double depth = 0.01;       ///< m
  double diameter = 0.016;   ///< m, of the tool
  double step_over = 0.5;    ///< of the diameter, from one rectangle to the next
  double step_down = 0.005;  ///< m, from one level to the next, at most
  double clearance = 0.02;   ///< m, of rapids over the surface
};

/// Throws InputError for a pocket that the tool does not fit into, or sizes not above zero.
Program pocket_program(const Pocket& pocket);

/// A straight cut from one point to another, m, work frame; `axis` (unit) from the tip to the
/// spindle.
Program line_program(const Vector3<double>& from, const Vector3<double>& to,
                     const Vector3<double>& axis);

}  // namespace flexcomp::programs
