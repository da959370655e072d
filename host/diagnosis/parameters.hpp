#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A parameter as it is reported.
struct Estimate {
  std::string name;
  std::string unit;
  double value = 0;
  double deviation = 0;  ///< standard; NaN where the fit does not tell
};

/// Parameters of one of a fit's hypotheses, and those that follow from them: amplitude and phase of
/// a ripple, a spring's whole compliance, a sensor's gain.
std::vector<Estimate> estimates(const Observations& observations, const Fit& fit,
                                std::size_t index);

}  // namespace flexcomp::diagnosis
