#pragma once

#include <Eigen/Core>
#include <optional>

#include "diagnosis/evaluator.hpp"
#include "diagnosis/least_squares.hpp"

namespace flexcomp::diagnosis {

/// The quantities that a fit makes small: what an evaluator's numbers leave, each number over its
/// tolerance, and the bodies beyond their edges. In numbers over their steps.
class HeldRemainder : public SumOfSquares {
 public:
  explicit HeldRemainder(Evaluator* evaluator);

  std::optional<double> half(const Eigen::VectorXd& numbers) override;
  std::optional<Quadratic> quadratic(const Eigen::VectorXd& numbers) override;
  /// The values that numbers over their steps are.
  Values values_of(const Eigen::VectorXd& numbers) const;

 protected:
  /// The remainder of values; none where they cannot be simulated. Its slope by them where it is
  /// wanted: a column a number, whose first rows are the remainder's.
  virtual std::optional<Eigen::VectorXd> left(const Values& values,
                                              Eigen::MatrixXd* slope) const = 0;

  Evaluator* evaluator_;

 private:
  double half_of(const Eigen::VectorXd& remainder, const Eigen::VectorXd& numbers,
                 const Eigen::VectorXd& beyond) const;
  /// How far the bodies are beyond their edges.
  Eigen::VectorXd outside(const Values& values) const;
  /// Bodies × numbers, given how far they are beyond their edges here.
  Eigen::MatrixXd outside_slope(const Values& values, const Eigen::VectorXd& here) const;

  Bodies bodies_;
  Eigen::VectorXd step_;  ///< what a number's unit is
  Eigen::VectorXd hold_;  ///< a number's unit over its tolerance
};

/// Minimises a held remainder within the numbers' bounds from the evaluator's values on, and sets
/// these.
void minimise(HeldRemainder* cost, const Steps& steps, Evaluator* evaluator);

}  // namespace flexcomp::diagnosis
