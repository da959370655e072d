#pragma once

#include "check/check.hpp"
#include "flexcomp/table.hpp"
#include "linux/options.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// Options of flexcompd beside the robot and the table that it is to correct: config.model
/// (another robot's fingerprint), config.speed (joint speeds that stop the robot's own motion, or
/// stop none), config.gain (above what the table's process allows), config.range (a wrench that the
/// table allows counts as implausible), config.axes (with RSI: how the controller's axes are
/// counted, and whether the URDF's geometry says the same). Without a robot or a table, what can be
/// said without.
Checks check_config(const std::string& file, const Options& options, const model::Robot* robot,
                    const Table* table);

/// config.deflection: limits of the deflection below what the robot bends by along a path under its
/// wrench, so that the correction is cut off or does not become active.
Checks check_deflection(const std::string& file, const Options& options, const model::Robot& robot,
                        const recording::Recording& path);

}  // namespace flexcomp::check
