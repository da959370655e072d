#pragma once

#include <memory>

#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {

/// The observations, the dictionary of hypotheses to choose from, how likely a false finding may
/// be, and the fit to begin with: what must be known before anything else can be told.
struct Inquiry {
  const Observations& observations;
  const Dictionary& dictionary;
  double false_discovery;
  const Fit& given;
};

/// Hypotheses whose starts were sought in what a fit leaves; null where none was found.
using Sought = std::shared_ptr<const Dictionary>;

/// A fit, and what was sought in what it leaves.
struct Attempt {
  Fit fit;
  Sought sought;
  bool is_of_families = false;  ///< grown no further: a machine's numbers together account for more
};

/// A hypothesis with values to begin with, and what it promises.
struct Candidate {
  double gain;  ///< in BIC, by its linear part
  Chosen chosen;
  bool is_sought;     ///< of the attempt's `sought`, else of the inquiry's dictionary
  std::size_t entry;  ///< of that dictionary
};

/// How much an effect at a place would explain alone, by its linear part.
struct Ranked {
  std::string effect;
  int joint = 0;
  double gain = 0;  ///< in BIC
};

/// Seeks new starts in what a fit leaves, for the hypotheses that need it.
Sought seek(const Inquiry& inquiry, const Fit& fit);

/// Every hypothesis beside a fit with the best of its starts, the most promising first.
std::vector<Candidate> propose(const Inquiry& inquiry, const Attempt& before);

/// Effects at places by what they explain alone, the best form of each.
std::vector<Ranked> rank(const std::vector<Candidate>& candidates);

/// The fits of the best pairs whose parts do not cancel each other.
std::vector<Fit> propose_pairs(const Inquiry& inquiry);

/// How a candidate, or one choice of a fit, changes the samples to fit to: for each of its
/// parameters a column of length one.
Eigen::MatrixXd directions(const Inquiry& inquiry, const Attempt& before,
                           const Candidate& candidate);
Eigen::MatrixXd directions(const Observations& observations, const Fit& fit, std::size_t index);

/// Do two, by their directions, show in the same samples? Else neither can stand in for the other.
bool meet(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other);

}  // namespace flexcomp::diagnosis
