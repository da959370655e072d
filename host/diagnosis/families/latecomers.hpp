#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Hypotheses that join families once these are fitted (`Traits::joins_family`), since they are not
/// linear in all their numbers or few machines have them: those whose columns explain more of what
/// is left than chance would, beside all that is fitted, each at the best of its starts.
///
/// A form of friction brings the linear forms of its joint that were left out, where the two
/// explain more together: friction that first falls with speed and then rises looks like dry
/// friction alone to either of the two.
std::vector<Chosen> latecomers(const Observations& observations, const Fit& fit,
                               const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
