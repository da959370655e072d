#pragma once

#include <vector>

namespace flexcomp::control {

/// The one positive root of γ⁴ + p γ − r = 0, r > 0, in closed form (Ferrari, Cardano) without
/// cancellation, then two steps of Newton. The signs of the coefficients change once, so there is
/// exactly one (Descartes).
double positive_root(double p, double r);

/// All positive real roots of the same, as eigenvalues of the companion matrix: the second opinion.
std::vector<double> positive_roots_by_companion(double p, double r);

}  // namespace flexcomp::control
