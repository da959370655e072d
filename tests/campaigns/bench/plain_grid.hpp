#pragma once

#include "milled_circle.hpp"

namespace flexcomp::bench {

/// Ranges of joints 2 to 5 along the circle, rad.
void joint_ranges(const MilledCircle& circle, GridRange<double> (*ranges)[4]);

/// A table as one would write it without much thought: compliances (21 floats of a symmetric
/// matrix) at equal steps of joints 2 to 5, blended linearly along each axis; joint 1 turns them
/// exactly.
struct PlainGrid {
  double step;   ///< rad
  double bytes;  ///< of all its nodes
};

/// The coarsest such grid over the joints' ranges whose deflection errs by no more than `error` (m,
/// rad) along the circle, for the worst wrench within the bounds of `path_table`. Looked at in
/// places only, not certified, which is in its favour.
PlainGrid coarsest_plain_grid(const MilledCircle& circle, double error);

}  // namespace flexcomp::bench
