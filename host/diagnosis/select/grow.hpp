#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// Tells how far it is: done, of how many.
using Tell = std::function<void(std::size_t, std::size_t)>;

/// Adds hypotheses one by one, each the best beside those before, as long as they hold; after each
/// step an earlier one is replaced where a better or simpler one does its work, and starts are
/// sought anew in what is left.
Attempt grow(const Inquiry& inquiry, Attempt attempt, const Tell& tell);

/// The best of a shortlist beside a fit, fitted; nothing chosen if the list is empty.
Fit best_beside(const Inquiry& inquiry, const Attempt& before, std::size_t most);

}  // namespace flexcomp::diagnosis
