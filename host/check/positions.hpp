#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// Do the measured positions lie where the model puts the TCP, to about a centimetre? If not: in
/// which unit, with which axes, in which frame, on which tool or by which sign, order or zero of a
/// joint they would. Names, by the one reading under which they fit: units.position, units.angle,
/// frame.base, tool.missing, joint.sign, joint.order, joint.zero; model.other where none fits.
///
/// `recording` is corrected by what is named, so that what else is wrong with it shows.
Checks check_positions(const model::Robot& robot, recording::Recording* recording);

}  // namespace flexcomp::check
