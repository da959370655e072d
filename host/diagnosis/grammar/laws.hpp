#pragma once

#include "diagnosis/grammar/budget.hpp"
#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis::grammar {

/// Explains what a fit leaves by laws that nobody listed, and by effects of the catalogue beside
/// them: grows the fit by whichever accounts for more, one at a time, as long as it holds. A law
/// must be far better than the best effect of the catalogue; what stands in the end is judged as
/// every finding, and an effect that does as well as a law takes its place.
///
/// No findings where no law is among them. Nothing more is begun once the budget is spent.
Choice choose_laws(const Inquiry& inquiry, const Fit& begun, Budget* budget, const Tell& tell);

/// Is a finding a law that was composed or written, and none of the catalogue?
bool is_law(const Hypothesis& hypothesis);

}  // namespace flexcomp::diagnosis::grammar
