#pragma once

#include "diagnosis/grammar/budget.hpp"
#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis::grammar {

/// What is added first: whatever accounts for more, or a law, even where an effect of the catalogue
/// accounts for more. An effect may take a part of what two causes do, and leave of the other what
/// no law is.
enum class First { any, law };

/// Explains what a fit leaves by laws that nobody listed, and by effects of the catalogue beside
/// them. Adds the one that accounts for more, one at a time, as long as it holds. A law must be far
/// better than the best effect of the catalogue. In the end all are judged as every finding is, and
/// an effect that does as well as a law takes its place.
///
/// There are no findings unless a law is among them. Once the budget is spent nothing more is
/// begun.
Choice choose_laws(const Inquiry& inquiry, const Fit& begun, First first, Budget* budget,
                   const TellStage& tell);

/// Is a law among the findings that nobody listed?
bool has_law(const Choice& choice);

}  // namespace flexcomp::diagnosis::grammar
