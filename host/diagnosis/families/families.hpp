#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// The findings, behind them extras (coupled drives, late clocks), and behind those the numbers
/// that stay.
struct Families {
  Fit fit;
  std::vector<Chosen> extras;  ///< as they are in the fit
};

/// Fits whole families of a machine's numbers at once, beside findings: geometry (frames, axes,
/// lengths, zeros), elasticity (joints, base, tool), friction (dry, viscous), inertia (rotors,
/// masses) and zeros of the torques, as far as the observations show them.
///
/// A real machine is a little off in all of them. One alone explains next to nothing then, so that
/// a search for one cause at a time finds none. Which numbers stay is decided by how well they
/// predict what they were not fitted to (elimination.hpp); what stays is fitted again by
/// simulation, held to the model by the same tolerances, without numbers that cannot be.
///
/// Coupled drives and late clocks are far from linear, so that they are sought before the numbers
/// are settled; the search begins with those that are `known`.
Families fit_families(const Observations& observations, const Fit& findings,
                      const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                      const std::vector<Chosen>& known = {});

}  // namespace flexcomp::diagnosis
