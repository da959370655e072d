#pragma once

#include "flexcomp/model.hpp"
#include "programs/corrected_program.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// Puts a correction into the program that a path was planned from.
///
/// `path` is that path, wherever it was placed; `corrected` has the same rows corrected. Each
/// motion goes to its corrected end; points are added only where the correction bends by more than
/// `tolerance` (m; a radian counts as `kTurningLever`) off the motion between two points.
///
/// Throws InputError where the recordings lack q_cmd or the program's lines, are not of this
/// program, do not have the same rows, or lie farther apart than a correction can be.
programs::CorrectedProgram correct_program(const RobotModel<double, 6>& model,
                                           const programs::Program& program,
                                           const recording::Recording& path,
                                           const recording::Recording& corrected, double tolerance);

}  // namespace flexcomp::planning
