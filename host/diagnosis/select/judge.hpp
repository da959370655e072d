#pragma once

#include "diagnosis/select/propose.hpp"

namespace flexcomp::diagnosis {

/// An effect that would do nearly as well in the place of a finding.
struct Alternative {
  std::string effect;
  int joint = 0;
  double delta_bic = 0;  ///< how much worse than the finding
  Chosen chosen;
};

/// An effect at a place, as a person names it.
struct Place {
  std::string effect;
  int joint = 0;

  bool operator==(const Place& other) const {
    return effect == other.effect && joint == other.joint;
  }
};

/// A finding: a law at a place with its values, the evidence for it, and its alternatives.
struct Finding {
  Chosen chosen;
  Eigen::MatrixXd covariance;  ///< of its values, were nothing off but what was found
  Evidence evidence;
  Fit without;  ///< all other findings, fitted
  std::vector<Alternative> alternatives;
  Eigen::VectorXd hidden;  ///< variance of each value by confounders; empty: none was sought
  std::vector<Place> confounders;  ///< that widen an interval most, the worst first

  /// Covariance of the values, whatever hides beside them.
  Eigen::MatrixXd whole_covariance() const;
};

/// A fit, and each of its choices weighed against all others.
struct Selection {
  Fit fit;
  std::vector<Finding> findings;
};

/// The evidence for the last choice of a fit.
Evidence weigh_last(const Inquiry& inquiry, const Fit& before, const Fit& after);

/// Weighs one choice of a fit, all others being there.
Finding judge(const Inquiry& inquiry, const Fit& whole, std::size_t index);

/// Are values that act in proportion known to differ from nothing, given their covariance, as the
/// interval that is told with them says? A hypothesis without such values counts as known.
bool are_told_from_nothing(const Chosen& chosen, const Eigen::MatrixXd& covariance);

/// Is the evidence enough to keep a hypothesis while findings are sought?
bool holds(const Inquiry& inquiry, const Evidence& evidence);

/// Is the evidence enough for a finding in the end? It must lower the held-out error by itself.
bool stands(const Inquiry& inquiry, const Evidence& evidence);

/// Can the last hypothesis of a fit be, as fitted?
bool can_be(const Inquiry& inquiry, const Fit& fit);

/// BIC but for a constant: the smaller the better, for fits of any hypotheses. A parameter that
/// rests at a bound does not count: a base does not give in all directions.
double criterion(const Observations& observations, const Fit& fit);

/// Does a fit hold, and does evidence speak for it against another: strong evidence, or any if it
/// has fewer findings?
bool is_better(const Inquiry& inquiry, const Fit& one, const Fit& other);

/// The better of two attempts, with what was sought in what its own fit leaves.
Attempt better_of(const Inquiry& inquiry, Attempt best, Attempt rival);

/// Is there no strong evidence for the richer fit?
bool is_as_good(const Inquiry& inquiry, const Fit& plain, const Fit& rich);

/// Does what was held out speak for the richer fit?
bool is_confirmed(const Inquiry& inquiry, const Fit& plain, const Fit& rich);

/// A fit with one choice more, and without one of them.
Fit fit_with(const Inquiry& inquiry, const Fit& before, const Chosen& chosen, int steps);
Fit fit_without(const Inquiry& inquiry, const Fit& whole, std::size_t index);

}  // namespace flexcomp::diagnosis
