#pragma once

#include <Eigen/Core>
#include <optional>

namespace flexcomp::diagnosis {

/// Half a sum of squares about a place, to second order as Gauss and Newton have it.
struct Quadratic {
  double half = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd curvature;  ///< squares of the slopes; never negative
};

/// A sum of squares as a function of numbers.
class SumOfSquares {
 public:
  virtual ~SumOfSquares() = default;
  /// Half the sum; none where it has no value.
  virtual std::optional<double> half(const Eigen::VectorXd& numbers) = 0;
  /// The same and its slopes.
  virtual std::optional<Quadratic> quadratic(const Eigen::VectorXd& numbers) = 0;
};

/// The smallest and largest values of each number.
struct Box {
  Eigen::VectorXd lower, upper;

  Eigen::VectorXd nearest(const Eigen::VectorXd& numbers) const {
    return numbers.cwiseMax(lower).cwiseMin(upper);
  }
};

struct Steps {
  int most = 0;             ///< that are taken
  double least_change = 0;  ///< part of the sum of squares, below which a step ends the search
};

/// The numbers of the least sum of squares within a box, sought from a place in it on: damped steps
/// (Levenberg and Marquardt, damping by Nielsen 1999), each the best of those that stay in the box
/// but for what their own course shows to leave it. Gives the place itself where the sum has no
/// value there.
Eigen::VectorXd least_squares(SumOfSquares* squares, const Box& box, Eigen::VectorXd numbers,
                              const Steps& steps);

}  // namespace flexcomp::diagnosis
