#include "flexcomp/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp {
namespace {

template <typename Scalar>
bool is_positive(Scalar value) {
  return std::isfinite(value) && value > Scalar(0);
}

}  // namespace

template <typename Scalar>
Result Guard<Scalar>::configure(const CorrectionLimits<Scalar>& limits, Scalar period) {
  if (!is_positive(limits.value) || !is_positive(limits.rate) ||
      !is_positive(limits.acceleration) || !is_positive(period)) {
    return Result::bad_config;
  }
  const Scalar unit = limits.value * std::numeric_limits<Scalar>::epsilon();
  const Scalar change = limits.acceleration * period * period;
  const Scalar step = limits.rate * period;
  // Twice the largest value is a distance to go, and the reserve for rounding must itself be exact.
  if (!std::isfinite(Scalar(2) * limits.value) || unit < std::numeric_limits<Scalar>::min() ||
      !(change >= Scalar(128) * unit) || !std::isfinite(change) || !std::isfinite(step) ||
      !(step >= change / Scalar(64))) {
    return Result::bad_config;
  }
  *this = Guard();
  largest_value_ = limits.value - unit;
  largest_change_ = change - Scalar(2) * unit;
  largest_step_ = std::max(step - unit, step / Scalar(2));
  return Result::ok;
}

/// Largest step from which braking ends within `distance`, the step itself included.
template <typename Scalar>
Scalar Guard<Scalar>::braking_step(Scalar distance) const {
  // Planning with a little less than the allowed deceleration leaves room to absorb rounding.
  const Scalar change = largest_change_ * Scalar(31) / Scalar(32);
  if (distance <= change) {
    return distance;
  }
  const Scalar d = distance / change;
  const Scalar whole = std::floor((std::sqrt(Scalar(1) + Scalar(8) * d) - Scalar(1)) / Scalar(2));
  const Scalar rest = d - whole * (whole + Scalar(1)) / Scalar(2);
  const Scalar fraction = std::clamp(rest / (whole + Scalar(1)), Scalar(0), Scalar(1));
  return (whole + fraction) * change;
}

template <typename Scalar>
Scalar Guard<Scalar>::advance(Scalar target) {
  const Scalar wanted = std::isfinite(target) ? target : value_;
  const Scalar goal = std::clamp(wanted, -largest_value_, largest_value_);
  limited_by_value_ = goal != wanted;

  const Scalar distance = goal - value_;
  const Scalar reach = std::min(braking_step(std::abs(distance)), largest_step_);
  Scalar step = distance < Scalar(0) ? -reach : reach;
  step = std::clamp(step, step_ - largest_change_, step_ + largest_change_);
  limited_by_rate_ = step != distance;

  const Scalar next =
      limited_by_rate_ ? std::clamp(value_ + step, -largest_value_, largest_value_) : goal;
  step_ = next - value_;
  value_ = next;
  return value_;
}

template class Guard<float>;
template class Guard<double>;

}  // namespace flexcomp
