#pragma once

/// Tails of the usual distributions, by Boost.Math, which is compiled here once for all.
namespace flexcomp::statistics {

/// The chance that a variable with the χ² distribution of `freedom` (> 0) exceeds `value` (>= 0).
double chi_squared_above(double value, double freedom);

/// The same of Fisher's F distribution; `more` and `left` (> 0) are the degrees of freedom of
/// numerator and denominator.
double fisher_above(double value, double more, double left);

/// The same of the standard normal distribution.
double normal_above(double value);

/// The number that a variable with Student's t distribution of `freedom` (> 0) exceeds with this
/// chance (0 to 1, without the ends).
double student_exceeds(double chance, double freedom);

}  // namespace flexcomp::statistics
