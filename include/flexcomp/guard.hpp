#pragma once

#include "flexcomp/status.hpp"

namespace flexcomp {

/// Limits of one joint's correction.
template <typename Scalar>
struct CorrectionLimits {
  Scalar value;         ///< rad, largest magnitude
  Scalar rate;          ///< rad/s
  Scalar acceleration;  ///< rad/s²
};

/// Moves one joint's correction towards a target, one control period a step, as fast as its limits
/// allow and so that it can always stop before the largest value.
///
/// The promise: whatever the targets, finite or not, no value exceeds `limits.value`, no difference
/// of two values in a row `limits.rate * period`, and no second difference
/// `limits.acceleration * period²`. The promise is about the values as they are stored, so it keeps
/// two units in the last place of the largest value in reserve for rounding.
///
/// Braking follows the exact discrete distance: from a speed of n + f steps of the largest
/// acceleration (n whole, 0 ≤ f < 1), stopping takes (n + 1)(n/2 + f) of them.
template <typename Scalar>
class Guard {
 public:
  /// Returns bad_config unless all numbers are finite and positive, twice `limits.value` is finite
  /// and its unit in the last place no denormal number, and the acceleration is large enough for
  /// the precision of Scalar: acceleration * period² ≥ 128 such units, and rate * period ≥ 1/64 of
  /// it.
  Result configure(const CorrectionLimits<Scalar>& limits, Scalar period);

  /// One period further. A target that is not finite counts as the present value. Constant time.
  Scalar advance(Scalar target);

  Scalar value() const { return value_; }

  /// Is the correction at zero and at rest?
  bool is_at_rest_at_zero() const { return value_ == Scalar(0) && step_ == Scalar(0); }

  /// Did the last call fall short of the target it was given, and why?
  bool limited_by_value() const { return limited_by_value_; }
  bool limited_by_rate() const { return limited_by_rate_; }

 private:
  Scalar braking_step(Scalar distance) const;

  Scalar largest_value_ = 0;
  Scalar largest_step_ = 0;    ///< largest difference of two values in a row
  Scalar largest_change_ = 0;  ///< largest difference of two steps in a row
  Scalar value_ = 0;
  Scalar step_ = 0;
  bool limited_by_value_ = false;
  bool limited_by_rate_ = false;
};

}  // namespace flexcomp
