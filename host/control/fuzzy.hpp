#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace flexcomp::control {

/// A closed interval.
struct Interval {
  double lower;
  double upper;
};

/// An uncertain quantity described by a fuzzy set: each value belongs to it to a degree from 0
/// to 1.
///
/// Kept as its α-cuts, the intervals of the values that belong to a degree of at least α.
/// Arithmetic is interval arithmetic, cut by cut (decomposition theorem), operands taken for
/// independent. The cuts stand at the nodes of a composite Gauss–Legendre rule, so that integrals
/// over α are exact for cuts that are polynomials of α up to the seventh degree, as products of
/// triangular and trapezoidal numbers are.
class FuzzyNumber {
 public:
  /// A number that is known.
  static FuzzyNumber crisp(double value);

  /// Degree 0 at `lower` and `upper`, 1 at `mode`. Throws InputError unless they are finite and in
  /// order; so do the two below.
  static FuzzyNumber triangular(double lower, double mode, double upper);

  /// Degree 1 from `first` to `last`.
  static FuzzyNumber trapezoidal(double lower, double first, double last, double upper);

  /// Degrees straight between points (value, degree) with increasing values; they rise to 1 and
  /// fall again.
  static FuzzyNumber tabulated(const std::vector<std::pair<double, double>>& points);

  Interval support() const { return {lower_[0], upper_[0]}; }

  FuzzyNumber operator+(const FuzzyNumber& other) const;
  FuzzyNumber operator-(const FuzzyNumber& other) const;
  FuzzyNumber operator*(const FuzzyNumber& other) const;
  FuzzyNumber operator*(double factor) const;
  FuzzyNumber operator/(double divisor) const { return *this * (1 / divisor); }

  /// The square of one number, which is not the product of two independent ones.
  FuzzyNumber squared() const;
  FuzzyNumber magnitude() const;

  /// D-operation on ν and on ν²: the mean of the power, weighted by degree. A crisp number's is
  /// itself.
  double mean() const;
  double mean_square() const;

 private:
  static constexpr int kPanels = 48;
  static constexpr int kNodes = 4;
  static constexpr int kCuts = kPanels * kNodes;
  using Cuts = Eigen::Array<double, kCuts + 1, 1>;  ///< the support, then the nodes

  static const Cuts& levels();
  static const Cuts& weights();
  double mean_of_power(int power) const;

  Cuts lower_;
  Cuts upper_;
};

}  // namespace flexcomp::control
