#pragma once

#include <vector>

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Physics that is far from linear, so that it must be there before the numbers are fitted: a drive
/// that turns with the joint before its own, torques whose clock is late or early.
struct Extra {
  Chosen chosen;
  double gain = 0;  ///< fall of the sum of squares, to first order
};

/// Extras that a fit of numbers lacks, in the order of their gains.
std::vector<Extra> propose_extras(const Observations& observations, const Fit& fit,
                                  const std::vector<Hypothesis>& hypotheses);

/// Is an extra, as fitted, one that can be, and no mere touch of it? `index`: its place in the fit.
bool is_real(const Observations& observations, const Fit& fit, std::size_t index);

/// The dictionary with the numbers of a coupled drive as they act through its coupling.
Dictionary with_coupled_drive(const Observations& observations, const Dictionary& dictionary,
                              const Chosen& coupling);

}  // namespace flexcomp::diagnosis
