#pragma once

#include <vector>

#include "diagnosis/dictionary.hpp"
#include "diagnosis/families/families.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// The refit of a machine's own numbers beside findings that predicts best what was held out: of
/// the few numbers that every model has (compliances, friction), or of whole families
/// (families.hpp). It stands in for physics that was not found.
///
/// Returns the findings, fitted anew, and behind them the numbers. Nothing is chosen unless all of
/// them can be (plausible.hpp), the evidence for all of them together is strong, and the held-out
/// error falls in a channel and rises in none.
Fit retune(const Observations& observations, const Fit& findings,
           const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

/// Whole families alone beside the `given` fit; nothing chosen unless they stand as above.
/// `known`: coupled drives and late clocks to begin with.
Families retune_whole(const Observations& observations, const Fit& given,
                      const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary,
                      const std::vector<Chosen>& known = {});

}  // namespace flexcomp::diagnosis
