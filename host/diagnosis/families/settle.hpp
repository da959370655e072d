#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Numbers that a linear choice ends with, and the deviation to which their tolerances are scaled.
struct Start {
  std::vector<Chosen> chosen;
  double deviation = 1;
};

/// Fits by simulation from numbers close by on, until all that stay behind the first `findings` can
/// be. Numbers that cannot be go; bodies are held closer to the model's before they go too.
Fit settle(const Observations& observations, const Start& start, std::size_t findings,
           const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
