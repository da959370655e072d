#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Fits whole families of a machine's numbers at once, beside findings: geometry (frames, axes,
/// lengths, zeros), elasticity (joints, base, tool), friction (dry, viscous), inertia (rotors,
/// masses) and zeros of the torques, as far as the observations show them.
///
/// A real machine is a little off in all of them. One alone explains next to nothing then, so that
/// a search for one cause at a time finds none. Which numbers stay is decided by how well they
/// predict what they were not fitted to (elimination.hpp); what stays is fitted again by
/// simulation, held to the model by the same tolerances, without numbers that cannot be.
///
/// Returns the findings and behind them the numbers that stay.
Fit fit_families(const Observations& observations, const Fit& findings,
                 const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
