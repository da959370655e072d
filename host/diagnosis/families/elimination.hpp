#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Deviation over the noise that the samples to fit to would have of a remainder, if independent
/// ones had to say as much as all of them: what holds a number is weighed against it. Of positions,
/// which tell frames and tools whole, each sample counts.
double deviation_of(const Observations& observations, const Eigen::VectorXd& remainder);

/// One hypothesis of a linear fit, and the columns that are its own.
struct Member {
  Chosen chosen;
  std::vector<Eigen::Index> columns;
  bool is_given = false;  ///< stays whatever its evidence is here
};

/// Findings and the numbers of a machine's families as columns of the samples to fit to, their
/// least squares, and which of them predict best.
///
/// The fit has Huber's weights, and is held to the model by a tolerance of each number. Numbers are
/// left out one at a time (gains all at once), the least certain first, until none is left; of all
/// sets on that way the one is taken that predicts best stretches of time (or of poses) that it was
/// not fitted to. The tolerances are tried from tight to loose in the same manner: a recording that
/// tells much needs no belief in the model, one of a few poses does.
///
/// Positions tell frames and springs only in combinations. What they do not tell is held by the
/// size that the numbers of the same kind have, so that no large ones cancel each other.
class Elimination {
 public:
  Elimination(const Observations& observations, const Fit& given,
              const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

  /// The same anew about a fit of findings and, behind the first `given` of it, numbers: those may
  /// go again, others may come.
  Elimination(const Observations& observations, const Fit& about, std::size_t given,
              const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

  /// The members of the best set with their values, each within its bounds and with its tolerance.
  std::vector<Chosen> best();

  /// Deviation of what the best set leaves by which its tolerances are scaled (deviation_of).
  double deviation() const;

  /// What all members together leave of the samples to fit to, held by their usual tolerances.
  Eigen::VectorXd fullest_remainder();

  /// Robust sum of squares that the best set leaves in stretches that it was not fitted to.
  double least_error();

 private:
  /// Members in use, by index, and the error of a set in stretches that it was not fitted to.
  struct Set {
    std::vector<std::size_t> members;
    std::vector<bool> is_held;  ///< by column: at zero, since it would leave its bounds
    double tolerance = 0;
    Eigen::VectorXd widest;
    double error = 0;
  };

  /// Normal equations of some samples, and the squares of what they are to explain.
  struct Equations {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
    double square = 0;
  };

  /// By column; zero where it is not in use.
  struct Estimate {
    Eigen::VectorXd value;
    Eigen::VectorXd variance;
  };

  template <typename Columns>
  void add(Member member, const Columns& columns);
  std::vector<Eigen::Index> columns_of(const std::vector<std::size_t>& members) const;
  Eigen::VectorXd tolerance() const;
  Eigen::VectorXd precision() const;
  Equations equations_of(const std::vector<Eigen::Index>& rows,
                         const Eigen::VectorXd& weight) const;
  void prepare_plain();
  std::vector<Equations> weighted_parts() const;
  void begin_anew();
  void solve(const std::vector<std::size_t>& members);
  Eigen::VectorXd solution(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment,
                           const std::vector<Eigen::Index>& columns) const;
  double error_elsewhere(const std::vector<std::size_t>& members) const;
  std::vector<std::vector<std::size_t>> leaving_together(
      const std::vector<std::size_t>& members) const;
  std::vector<std::size_t> weakest_of(const std::vector<std::size_t>& members,
                                      const Eigen::VectorXd& widenings) const;
  Eigen::Index farthest_out(const std::vector<std::size_t>& members) const;
  void hold_impossible(const std::vector<std::size_t>& members);
  std::vector<std::size_t> all_members() const;
  Eigen::VectorXd widenings() const;
  void learn_widths();
  Set best_on_path();
  Set best_of_tolerances();
  Set best_set();
  Estimate estimate(const std::vector<Eigen::Index>& columns) const;
  Eigen::VectorXd widenings_by_others(const std::vector<std::size_t>& members) const;
  std::vector<Chosen> chosen_of(const Set& set);

  const Observations& observations_;
  Eigen::VectorXd target_;  ///< what the given findings leave, over the noise
  std::vector<Member> members_;
  Eigen::MatrixXd columns_;  ///< samples to fit to × all columns, over the noise
  Eigen::VectorXd unit_;     ///< of each number: it alone would change as much as is to explain
  std::vector<std::pair<double, double>> bounds_;
  /// The largest standard deviation of each number: over its plausible range, or what models are
  /// usually off by. Positions show themselves by how much this one is.
  Eigen::VectorXd widest_;
  std::vector<bool> is_held_;
  Eigen::VectorXd weight_, remainder_, value_;
  double spread_ = 1;     ///< of the remainder, over the noise
  double repeats_ = 1;    ///< samples of the remainder for each that is independent
  double tolerance_ = 0;  ///< times each number's unit: how far the model may be off
  /// Samples of each part, and normal equations of them where all weigh one.
  std::vector<std::vector<Eigen::Index>> rows_;
  std::vector<Equations> plain_;
  /// Normal equations of all samples, and of those of each part, with their weights.
  Eigen::MatrixXd gram_;
  Eigen::VectorXd moment_;
  std::vector<Equations> parts_;
};

}  // namespace flexcomp::diagnosis
