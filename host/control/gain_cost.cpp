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

}  // namespace flexcomp::control
