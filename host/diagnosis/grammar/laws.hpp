#pragma once

#include "diagnosis/grammar/budget.hpp"
#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis::grammar {

/// Explains what a fit leaves by laws that nobody listed, and by effects of the catalogue beside
/// them. Adds the one that accounts for more, one at a time, as long as it holds. A law must be far
/// better than the best effect of the catalogue. In the end all are judged as every finding is, and
/// an effect that does as well as a law takes its place.
///
/// There are no findings unless a law is among them. Once the budget is spent nothing more is
/// begun.
Choice choose_laws(const Inquiry& inquiry, const Fit& begun, Budget* budget, const TellStage& tell);

/// Is a law among the findings that nobody listed?
bool has_law(const Choice& choice);

}  // namespace flexcomp::diagnosis::grammar
