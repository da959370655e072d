#pragma once

/// @file
/// Limits of a correction, which hold whatever the target.

#include <array>

#include "flexcomp/status.hpp"
#include "flexcomp/types.hpp"

namespace flexcomp {

/// Limits of one joint's correction.
template <typename Scalar>
struct CorrectionLimits {
  Scalar value;         ///< rad, largest magnitude
  Scalar rate;          ///< rad/s
  Scalar acceleration;  ///< rad/s²
};

/// Limits in units of a control period, less a reserve for rounding.
template <typename Scalar>
struct GuardBounds {
  Scalar value = 0;   ///< largest magnitude
  Scalar step = 0;    ///< largest difference of two values in a row
  Scalar change = 0;  ///< largest difference of two steps in a row
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

  Scalar value() const { return value_; }                        ///< rad, of the correction
  const GuardBounds<Scalar>& bounds() const { return bounds_; }  ///< in use

  /// Is the correction at zero and at rest?
  bool is_at_rest_at_zero() const { return value_ == Scalar(0) && step_ == Scalar(0); }

  /// Did the last call fall short of the target it was given, and why?
  bool limited_by_value() const { return limited_by_value_; }
  bool limited_by_rate() const { return limited_by_rate_; }  ///< or by acceleration

 private:
  GuardBounds<Scalar> bounds_;
  Scalar value_ = 0;
  Scalar step_ = 0;
  bool limited_by_value_ = false;
  bool limited_by_rate_ = false;
};

/// A guard for each joint: the same numbers to the bit, side by side in vector registers where the
/// processor has them.
template <typename Scalar, int Joints>
class JointGuards {
  using Angles = JointVector<Scalar, Joints>;

 public:
  /// Returns bad_config if a guard does for one joint; they are not to be used then.
  Result configure(const std::array<CorrectionLimits<Scalar>, Joints>& limits, Scalar period);

  /// One period further, towards targets in rad; returns the corrections.
  Angles advance(const Angles& targets);

  /// Are all corrections at zero and at rest?
  bool is_at_rest_at_zero() const {
    constexpr std::array<Scalar, Joints> kZero{};
    return value_ == kZero && step_ == kZero;
  }

  /// Did the last call fall short of a target, of any joint, and why?
  bool limited_by_value() const { return limited_by_value_; }
  bool limited_by_rate() const { return limited_by_rate_; }  ///< or by acceleration

 private:
  std::array<Scalar, Joints> largest_value_{};
  std::array<Scalar, Joints> largest_step_{};
  std::array<Scalar, Joints> largest_change_{};
  std::array<Scalar, Joints> value_{};
  std::array<Scalar, Joints> step_{};
  bool limited_by_value_ = false;
  bool limited_by_rate_ = false;
};

}  // namespace flexcomp
