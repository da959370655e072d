#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/csv.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// Times that do not increase, before anything else can be said of a table: units.time. Leaves
/// those rows out of `table`.
Checks check_order_of_times(recording::NumberTable* table);

/// Are the times seconds, are there gaps, does each row hold a sample of its own, and is its time
/// when that was taken: units.time, time.gap, time.repeated, time.uneven. By how smoothly and how
/// fast the joints move against their limits; of a load test, whose times count rows, nothing is
/// said. `recording` is corrected by what is named. Without a robot, by the motion's smoothness
/// alone.
Checks check_times(const model::Robot* robot, recording::Recording* recording);

}  // namespace flexcomp::check
