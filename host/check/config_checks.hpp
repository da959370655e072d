#pragma once

#include "check/check.hpp"
#include "flexcomp/table.hpp"
#include "linux/options.hpp"
#include "model/robot.hpp"

namespace flexcomp::check {

/// Options of flexcompd beside the robot and the table that it is to correct: config.model
/// (another robot's fingerprint), config.speed (joint speeds that stop the robot's own motion, or
/// stop none), config.gain (above what the table's process allows), config.range (a wrench that the
/// table allows counts as implausible), config.axes (with RSI: how the controller's axes are
/// counted, and whether the URDF's geometry says the same). Without a robot or a table, what can be
/// said without.
Checks check_config(const std::string& file, const Options& options, const model::Robot* robot,
                    const Table* table);

}  // namespace flexcomp::check
