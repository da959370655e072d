#pragma once

#include "diagnosis/select/judge.hpp"
#include "diagnosis/stage.hpp"

namespace flexcomp::diagnosis {

/// Adds hypotheses one by one, each the best beside those before, as long as they hold. After each
/// step it replaces an earlier one by a better or simpler one that does its work, and seeks starts
/// anew in what is left.
Attempt grow(const Inquiry& inquiry, Attempt attempt, const TellStage& tell);

/// The most promising hypotheses, at most so many, each fitted quickly beside a fit, the best
/// first. Fits of machines that cannot be are left out.
std::vector<Fit> tried_beside(const Inquiry& inquiry, const Attempt& before, std::size_t most);

/// The best fit with a hypothesis of a shortlist added; nothing chosen if the list is empty.
Fit best_beside(const Inquiry& inquiry, const Attempt& before, std::size_t most);

}  // namespace flexcomp::diagnosis
