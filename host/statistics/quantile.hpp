#pragma once

#include <vector>

namespace flexcomp::statistics {

/// The value that a share of all others (0 to 1) is below, the lower of two; 0 of none.
double quantile(std::vector<double> values, double share);

}  // namespace flexcomp::statistics
