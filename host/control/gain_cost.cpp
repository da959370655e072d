#include "control/gain_cost.hpp"

#include <cmath>

#include "control/quartic.hpp"

namespace flexcomp::control {
namespace {

/// b/(4λ): the residual is this over γ.
double reach(const GainProblem& problem) { return problem.share / (4 * problem.decay); }

double time_weight(const GainProblem& problem) {
  return 1 / (2 * problem.decay) + problem.residual_time;
}

}  // namespace

double GainCost::operator()(double gain) const {
  return constant - linear / gain + square / (gain * gain) + effort * gain * gain;
}

double GainCost::best() const { return positive_root(p(), r()); }

GainCost gain_cost(const GainProblem& problem) {
  const double rate = problem.decay;
  const double a = reach(problem);
  const double start = problem.start.mean();
  const double drift = problem.drift.mean();
  const double drift_square = problem.drift.mean_square() / (rate * rate);
  const double beta = problem.residual_time;
  GainCost cost{};
  cost.constant =
      (problem.start.mean_square() - 2 * start * drift / rate + drift_square) / (2 * rate) +
      beta * drift_square;
  cost.linear = a / rate * (start - drift / rate) - 2 * beta * a * drift / rate;
  cost.square = a * a * time_weight(problem);
  cost.effort = problem.effort;
  return cost;
}

std::pair<double, double> best_coupled(const GainProblem& first, const GainProblem& second) {
  constexpr int kMostSweeps = 200;
  // (V₁₀ + V₂₀) and (c₁ + c₂) take the places of V₀ and c in either part.
  GainProblem both = first;
  both.start = first.start + second.start;
  both.drift = first.drift + second.drift;
  const GainCost alone_first = gain_cost(both);
  both.share = second.share;
  both.effort = second.effort;
  const GainCost alone_second = gain_cost(both);
  const double mixed = 2 * time_weight(first) * reach(first) * reach(second);
  const auto given = [&](GainCost cost, double other) {
    cost.linear -= mixed / other;
    return cost.best();
  };
  double one = alone_first.best();
  double two = alone_second.best();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const double before = one;
    one = given(alone_first, two);
    two = given(alone_second, one);
    if (std::abs(one - before) <= 1e-15 * one) {
      break;
    }
  }
  return {one, two};
}

}  // namespace flexcomp::control
