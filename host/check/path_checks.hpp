#pragma once

#include "check/check.hpp"
#include "control/path_gain.hpp"
#include "flexcomp/table.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// A program that a robot is to run: units of angles and times, angles and speeds beyond the limits
/// (limits), jumps between rows (path.jump), stretches near a singularity (path.singular).
Checks check_path(const model::Robot& robot, recording::Recording path);

/// Does a cut along a path stay stable while it is corrected: process.unstable. For paths with
/// angles and a wrench within what the model can do; nothing is said of others.
Checks check_process(const model::Robot& robot, const recording::Recording& path,
                     const simulation::Process& process, const CorrectionLoop& loop);

/// Is a table of this robot (table.other), with a gain that is safe (process.unstable)?
Checks check_table(const model::Robot& robot, const std::string& file, const Table& table);

/// Does a table hold what a path needs: postures and loads (table.coverage).
Checks check_coverage(const model::Robot& robot, const Table& table,
                      const recording::Recording& path);

}  // namespace flexcomp::check
