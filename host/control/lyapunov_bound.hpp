#pragma once

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

}  // namespace flexcomp::control
