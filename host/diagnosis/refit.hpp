#pragma once

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// Were so many numbers of a machine found one by one that they are to be fitted together? Nothing
/// holds single ones to the size of their like.
bool are_many(const Inquiry& inquiry, const Fit& found);

/// Fits a machine's numbers in the place of those that were found one by one, if these are many;
/// else, or if too few stand there, beside the findings, and once more without them. Those that
/// stand are findings then, the others stand in for what is left.
void refit(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses, Diagnosis* diagnosis);

}  // namespace flexcomp::diagnosis
