#pragma once

#include "control/loop_gain.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::control {

/// Largest correction gain that is safe everywhere along a path: the least of `largest_safe_gain`
/// at its rows, with the process answering as `process` says to the nominal wrench of each row.
///
/// Never zero, which in a table means "not analysed": a process that digs in without any correction
/// gives 10⁻⁶. Throws InputError as Contour does.
double largest_safe_gain_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                               const simulation::Process& process, const CorrectionLoop& loop);

}  // namespace flexcomp::control
