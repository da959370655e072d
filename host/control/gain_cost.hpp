#pragma once

#include "control/fuzzy.hpp"

namespace flexcomp::control {

/// The trade of the gain γ of one robust term: how fast and how close the Lyapunov function comes,
/// against effort. The part η of the bound on it obeys η' = −λ η + b/(4γ) + c, η(0) = V₀.
struct GainProblem {
  double decay = 0;          ///< 1/s, λ
  double residual_time = 0;  ///< s, β: weight of where it settles against how it gets there
  double effort = 0;         ///< J²s·W², w: weight of γ²
  double share = 1;          ///< b
  FuzzyNumber start = FuzzyNumber::crisp(0);  ///< J, V₀
  FuzzyNumber drift = FuzzyNumber::crisp(0);  ///< W, c
};

/// J(γ) = κ₁ − κ₂/γ + κ₃/γ² + w γ²: the D-operation on ∫(transient)² dt + β (residual)², plus
/// effort.
struct GainCost {
  double constant;  ///< κ₁
  double linear;    ///< κ₂, of any sign
  double square;    ///< κ₃ > 0
  double effort;    ///< w

  double operator()(double gain) const;

  /// Stationary where γ⁴ + p γ − r = 0.
  double p() const { return linear / (2 * effort); }
  double r() const { return square / effort; }

  /// The gain of least cost: the root of the quartic. J falls before it and rises behind it.
  double best() const;
};

GainCost gain_cost(const GainProblem& problem);

}  // namespace flexcomp::control
