#pragma once

#include <vector>

#include "programs/program.hpp"

namespace flexcomp::planning {

/// The fewest motions of a motion's kind, by halving, that pass all poses from `first` to `last` to
/// a tolerance (m; a radian counts as `kTurningLever`), as a controller goes from one to the next:
/// the place by a straight line or an arc, the orientation by one rotation. Between the poses an
/// arc is as high above their chord as the motion's own, to the tolerance.
///
/// A straight line takes the place of an arc that does not fit and cannot be halved. A rapid has
/// one motion, to its end. There is one motion at least.
std::vector<programs::Motion> fit_motion(const programs::Motion& motion,
                                         const std::vector<Pose<double>>& poses, std::size_t first,
                                         std::size_t last, double tolerance);

}  // namespace flexcomp::planning
