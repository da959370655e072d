#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "diagnosis/search/hypothesis.hpp"

namespace flexcomp::diagnosis {

/// How hypotheses change what a machine predicts for observations.
class Changes {
 public:
  explicit Changes(const Observations& observations);
  /// Changes of a machine that is the observations' model with what is known of it already.
  Changes(const Observations& observations, const Machine& around);

  /// The whole change over the noise (samples), by the values of a hypothesis' parameters; to first
  /// order where it has a sketch.
  Eigen::VectorXd by(const Hypothesis& hypothesis, const Values& values) const;

  /// A column for each linear parameter, per unit of it, or one for a whole guess.
  Eigen::MatrixXd columns(const Hypothesis& hypothesis, const Values& start) const;

 private:
  /// Of the machine.
  const std::vector<Simulation>& simulations() const {
    return simulations_.empty() ? observations_.simulations : simulations_;
  }

  const Observations& observations_;
  Machine machine_;
  std::vector<simulation::RigidTorque> rigid_;  ///< of the machine
  std::vector<Simulation> simulations_;         ///< of the machine; empty where it is the model
  Eigen::VectorXd predicted_;                   ///< by the machine with its terms
};

/// A hypothesis with the starting values of what is not linear in it: columns of the dictionary.
struct Entry {
  std::size_t hypothesis;
  Values start;
  Eigen::Index first;  ///< column
  Eigen::Index count;
};

/// How every hypothesis would change the prediction, per unit of its linear parameters.
class Dictionary {
 public:
  /// Progress is told after each hypothesis: done, of how many.
  Dictionary(const Observations& observations, std::vector<Hypothesis> all,
             const std::function<void(std::size_t, std::size_t)>& progress);
  /// The dictionary of a machine that is the observations' model with what is known of it already.
  Dictionary(const Observations& observations, std::vector<Hypothesis> all, const Machine& around,
             const std::function<void(std::size_t, std::size_t)>& progress);

  /// The same, and behind it the entries of another.
  Dictionary with(const Dictionary& others, const Observations& observations) const;
  /// Some entries' hypotheses, which act at those times only.
  Dictionary by_turns(const std::vector<std::size_t>& of, const std::shared_ptr<const Spells>& when,
                      const Observations& observations) const;

  /// The first entry of a hypothesis; null where it does not show.
  const Entry* find(const Hypothesis& hypothesis) const;

  std::vector<Hypothesis> hypotheses;
  std::vector<Entry> entries;
  Eigen::MatrixXd columns;  ///< samples × columns, over the noise
  Eigen::MatrixXd gram;     ///< columns × columns, over the samples to fit to
  /// By which the torques of each joint are multiplied in the columns; empty where by nothing.
  Eigen::VectorXd gains;

 private:
  Dictionary() = default;
  Dictionary(const Observations& observations, std::vector<Hypothesis> all, const Changes& changes,
             const std::function<void(std::size_t, std::size_t)>& progress);
};

/// Amplitudes of columns, and by how much they lower the sum of squares.
struct LeastSquares {
  Eigen::VectorXd amplitude;
  double gain = 0;
};

/// Least squares by normal equations (`gram` and `moment` of the columns of entries of these
/// hypotheses, one after the other, of these lengths), within the hypotheses' bounds: parameters
/// that leave them (a mass that a recording cannot tell from its moments) are held at zero, the
/// farthest first.
LeastSquares solve_within_bounds(const std::vector<const Hypothesis*>& hypotheses,
                                 const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                                 const Eigen::VectorXd& length);

/// An entry's gain beside the hypotheses that are fitted already.
struct Screened {
  std::size_t entry = 0;
  double sum = 0;             ///< of squares that it would leave
  Eigen::VectorXd amplitude;  ///< of its columns
};

/// What a dictionary may explain of a remainder, beside columns that are fitted already (samples ×
/// p, the parameters' derivatives).
struct BesideFitted {
  BesideFitted(const Observations& observations, const Dictionary& dictionary,
               const Eigen::VectorXd& remainder, const Eigen::MatrixXd& fitted);

  double sum = 0;           ///< of the remainder's squares, less what the fitted columns may take
  Eigen::VectorXd product;  ///< of the dictionary's columns with that remainder
  Eigen::MatrixXd shared;   ///< of an orthonormal basis of the fitted columns with the dictionary's
};

/// Every entry; parameters out of bounds are held at zero, and entries of which nothing is left are
/// left out. Unsorted.
std::vector<Screened> screen(const std::vector<Hypothesis>& hypotheses,
                             const Dictionary& dictionary, const BesideFitted& beside);

/// Two entries that explain a residual together.
struct ScreenedPair {
  Screened first;
  Screened second;
  double sum = 0;  ///< of squares that both would leave
};

/// The best pairs, of different effects or joints, one start each, the smallest criterion (BIC)
/// first: each of the most promising entries with every other.
std::vector<ScreenedPair> screen_pairs(const Observations& observations,
                                       const std::vector<Hypothesis>& hypotheses,
                                       const Dictionary& dictionary, const BesideFitted& beside,
                                       std::size_t most);

/// The remainder of a fit of all linear entries at once to what is unexplained (all samples, over
/// the noise): the fullest fit there is.
struct FullestFit {
  Eigen::VectorXd remainder;  ///< of the samples to fit to
  Eigen::Index freedom = 0;   ///< samples less independent columns
};
FullestFit fit_all(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
                   const Dictionary& dictionary, const Eigen::VectorXd& unexplained);

/// Are an entry's amplitudes such that its hypothesis allows them?
bool within_bounds(const Hypothesis& hypothesis, const Eigen::VectorXd& amplitude);

/// The parameters that an entry with amplitudes stands for, within their bounds.
Values values_of(const Hypothesis& hypothesis, const Entry& entry,
                 const Eigen::VectorXd& amplitude);

}  // namespace flexcomp::diagnosis
