#pragma once

#include <string>
#include <vector>

#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis {

/// A law that a person suspected, weighed.
struct Trial {
  Hypothesis hypothesis;
  bool stands = false;         ///< it is among the findings
  std::string why;             ///< it does not stand; empty where it does
  std::vector<Chosen> chosen;  ///< the law as fitted by itself; empty where no start shows anything
  Eigen::MatrixXd covariance;  ///< of its values
  Evidence evidence;           ///< for it by itself
};

/// Weighs each written law of the hypotheses by itself, by the evidence that every hypothesis
/// needs, and says why one is not among the findings.
std::vector<Trial> weigh_trials(const Inquiry& inquiry, const Choice& choice);

}  // namespace flexcomp::diagnosis
