#pragma once

#include <Eigen/Core>

namespace flexcomp::control {

/// A Lyapunov function that obeys V' ≤ −λ V + δ: uniformly bounded, and ultimately below any level
/// above δ/λ.
struct LyapunovBound {
  double decay;  ///< 1/s, λ
  double drift;  ///< W, δ

  /// J, what V comes down to.
  double residual() const { return drift / decay; }

  /// Largest V at `time` (s) after it was `start` (J).
  double at(double start, double time) const;

  /// Uniform boundedness: V never exceeds this.
  double most(double start) const { return start > residual() ? start : residual(); }

  /// Uniform ultimate boundedness: V stays below `level` (J, above the residual) from this time (s)
  /// on.
  double time_to(double level, double start) const;
};

/// W, what a boundary layer (W), 1/γ, adds to δ: within it a robust term pushes less than its
/// bound. Both this and the next by the `weight` of the term's side in V.
double layer_drift(double weight, double layer);

/// W, what the leak (1/s) of the adaptation adds to δ: ½ leak αᵀ Γ⁻¹ α, with α the true parameters
/// of a bound and `rates` the diagonal of Γ.
double leak_drift(double weight, double leak, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                  const Eigen::Ref<const Eigen::VectorXd>& rates);

/// W, what the filter adds to δ: (κ |y|)²/(k_v D) at most, with |y|² (N²·m²) of its lag, the link's
/// damping k_v (1/s), the least inertia D (kg·m²) and the largest K/K₀, κ.
double filter_drift(double stiffness_factor, double lag_squared, double damping, double inertia);

}  // namespace flexcomp::control
