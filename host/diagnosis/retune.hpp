#pragma once

#include <vector>

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// The model's own numbers (joint compliances, viscous and Coulomb friction) fitted together to
/// what the findings leave and no effect accounts for. They are no findings: they stand in for
/// physics that the catalogue lacks, so that what is predicted comes nearer where the robot moves
/// as it was recorded.
///
/// Returns the fit of the findings, their parameters fitted anew beside the numbers, and behind
/// them the numbers. Numbers that cannot be told from what they are (by two standard deviations),
/// or cannot be as fitted (plausible.hpp), stay so. Nothing is chosen unless evidence for all of
/// them together is strong, the held-out error falls in a channel and rises in none, and they do
/// not imitate it by large changes that cancel each other.
Fit retune(const Observations& observations, const Fit& findings,
           const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
