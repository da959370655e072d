#pragma once

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A jump at one moment, as of a tracker whose tripod was bumped.
struct Jump {
  double time = 0;          ///< s, of the first recording
  double left = 0;          ///< sum of squares that it leaves, as Fit::train_sum
  std::size_t numbers = 0;  ///< of it: its size in each direction, and its moment
};

/// The jump of the TCP's measured place that accounts for most of a mismatch, beside a fit.
Jump jump_of_place(const Observations& observations, const Fit& beside);

/// Does a jump in the place of the last hypothesis of `with`, which grows gradually with time
/// (Traits::is_gradual), account for more? It goes the same way and counts as many numbers. An
/// approach to a limit imitates it.
///
/// `without`: the fit of all other hypotheses.
bool jumps_instead(const Observations& observations, const Fit& without, const Fit& with);

}  // namespace flexcomp::diagnosis
