#pragma once

#include <vector>

namespace flexcomp::statistics {

/// The middle value, of an even number the larger of both; 0 of none.
double median(std::vector<double> values);

}  // namespace flexcomp::statistics
