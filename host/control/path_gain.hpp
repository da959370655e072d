#pragma once

#include "flexcomp/loop_gain.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::control {

/// How strongly a cut answers itself along a path, with the process answering as `process` says to
/// the nominal wrench of each row. In milling the force is proportional to the area of the chip
/// (Altintas, Manufacturing Automation, ch. 2): a tool that stands deeper by δ, with a depth of cut
/// a, sees w (1 + δ/a).
///
/// A path that encloses no area has no sides: there the material is taken to be where it is worst,
/// at right angles to the feed. Throws InputError for a path without q_cmd or wrench.
FeedbackRange feedback_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                             const simulation::Process& process);

/// The process and the loop as a table states them beside its largest gain.
GainBasis gain_basis(const FeedbackRange& feedback, const simulation::Process& process,
                     const CorrectionLoop& loop);

/// The largest safe gain of a table in a controller of another period (s) and filter (Hz) than it
/// was made for: at most what the table states, and zero where it states none. A table does not
/// know the controller that it will run in.
double largest_gain_in(const TableHeader& header, double period, double filter_cutoff);

}  // namespace flexcomp::control
