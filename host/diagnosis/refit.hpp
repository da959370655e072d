#pragma once

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// Were so many numbers of a machine found one by one that they must be fitted together? Only
/// together are they held to the size of their like.
bool are_many(const Inquiry& inquiry, const Fit& found);

/// Are a machine's numbers better fitted beside the other findings than alone? The findings stay
/// where the numbers predict noticeably better with them, and where without them only bodies that
/// cannot be (a plain refit) predict as well: those stand in for what nobody knows.
bool is_better_beside(const Observations& observations, const Fit& alone, const Fit& beside);

/// Fits a machine's numbers together. If many were found one by one, they take the place of those.
/// If few were, or too few stand then, they are fitted beside the findings, and once more without
/// them. Numbers that stand become findings, the others stand in for what is left.
void refit(const Inquiry& inquiry, const std::vector<Hypothesis>& hypotheses, const TellStage& tell,
           Diagnosis* diagnosis);

}  // namespace flexcomp::diagnosis
