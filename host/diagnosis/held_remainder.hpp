#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>

#include "diagnosis/evaluator.hpp"

namespace flexcomp::diagnosis {

/// The quantities that a fit makes small: what an evaluator's numbers leave (the first rows), each
/// number over its tolerance, and the bodies beyond their edges. In numbers over their steps, as
/// Ceres sees them.
class HeldRemainder : public ceres::CostFunction {
 public:
  HeldRemainder(Eigen::Index rows, Evaluator* evaluator);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

  bool holds_bodies() const { return bodies_.size() > 0; }

 protected:
  /// The remainder of values, and its slope by them where it is wanted: a column a number, whose
  /// first rows are the remainder's. False where they cannot be simulated.
  virtual bool leave(const Values& values, Eigen::Ref<Eigen::VectorXd> left,
                     Eigen::MatrixXd* slope) const = 0;

  Evaluator* evaluator_;

 private:
  void differentiate(const Values& values, const Eigen::MatrixXd& slope,
                     const Eigen::VectorXd& outside, double* target) const;

  Eigen::Index rows_;
  Bodies bodies_;
};

struct Steps {
  int most = 0;
  double least_change = 0;   ///< part of the sum of squares, below which a step ends the search
  int most_shortenings = 0;  ///< of a step that bounds or bodies cut, before it is given up
};

/// Minimises a held remainder within the numbers' bounds (Levenberg and Marquardt) from the
/// evaluator's values on, and sets these.
void minimise(HeldRemainder* cost, const Steps& steps, Evaluator* evaluator);

}  // namespace flexcomp::diagnosis
