#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Hypotheses that join families once these are fitted (`Traits::joins_family`), since they are not
/// linear in all their numbers: those whose columns explain more of what is left than chance would,
/// beside all that is fitted, each at the best of its starts.
std::vector<Chosen> latecomers(const Observations& observations, const Fit& fit,
                               const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
