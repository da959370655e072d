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

/// A hypothesis with values to begin with, and the gain that it promises.
struct Candidate {
  double gain;  ///< in BIC, by its linear part
  Chosen chosen;
  bool is_sought;     ///< of the attempt's `sought`, else of the inquiry's dictionary
  std::size_t entry;  ///< of that dictionary
};

/// The gain of an effect at a place alone, by its linear part.
struct Ranked {
  std::string effect;
  int joint = 0;
  double gain = 0;  ///< in BIC
};

/// Seeks new starts in what a fit leaves, for the hypotheses that need it.
Sought seek(const Inquiry& inquiry, const Fit& fit);

/// All hypotheses beside a fit, each with the best of its starts, the most promising first.
std::vector<Candidate> propose(const Inquiry& inquiry, const Attempt& before);

/// Effects at places, each in its best form, by their gain alone.
std::vector<Ranked> rank(const std::vector<Candidate>& candidates);

/// A fit with one of the best pairs beside it, for each pair whose parts do not cancel each other.
std::vector<Fit> propose_pairs(const Inquiry& inquiry, const Fit& before);

/// Directions in which a candidate, or one choice of a fit, changes the samples to fit to: a column
/// of length one for each parameter.
Eigen::MatrixXd directions(const Inquiry& inquiry, const Attempt& before,
                           const Candidate& candidate);
Eigen::MatrixXd directions(const Observations& observations, const Fit& fit, std::size_t index);

/// Do two sets of directions show in the same samples? Otherwise neither effect can stand in for
/// the other.
bool meet(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other);

}  // namespace flexcomp::diagnosis
