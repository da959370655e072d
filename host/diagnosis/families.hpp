#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Fits whole families of a machine's numbers at once, beside findings: geometry (frames, axes,
/// lengths, zeros), elasticity (joints, base, tool), friction (dry, viscous), inertia (rotors,
/// masses) and zeros of the torques, as far as the observations show them.
///
/// A real machine is a little off in all of them. One alone explains next to nothing then, so that
/// a search for one cause at a time finds none. The fit is linear in the dictionary's columns, with
/// Huber's weights, and damped towards the model's numbers so that what the observations cannot
/// tell apart stays small. Numbers that cannot be told from the model's beside the others go, one
/// at a time, the least certain first; the remainder counts as correlated over time. What stays is
/// fitted again by simulation.
///
/// Returns the findings and behind them the numbers that stay.
Fit fit_families(const Observations& observations, const Fit& findings,
                 const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
