#include "flexcomp/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "checked_number.hpp"
#include "instantiate.hpp"
#include "packed_six.hpp"

namespace flexcomp {
namespace {

/// Of the allowed deceleration.
template <typename Scalar>
constexpr Scalar kPlanned = Scalar(31) / Scalar(32);

/// Largest step from which braking ends within `distance`, the step itself included.
template <typename Scalar>
Scalar braking_step(Scalar distance, Scalar largest_change) {
  // Planning with a little less than the allowed deceleration leaves room to absorb rounding.
  const Scalar change = largest_change * kPlanned<Scalar>;
  if (distance <= change) {
    return distance;
  }
  const Scalar d = distance / change;
  const Scalar whole = std::floor((std::sqrt(Scalar(1) + Scalar(8) * d) - Scalar(1)) / Scalar(2));
  const Scalar rest = d - whole * (whole + Scalar(1)) / Scalar(2);
  const Scalar fraction = std::clamp(rest / (whole + Scalar(1)), Scalar(0), Scalar(1));
  return (whole + fraction) * change;
}

/// Where a period takes a correction.
template <typename Scalar>
struct Advance {
  Scalar value;
  Scalar step;
  bool limited_by_value;
  bool limited_by_rate;
};

template <typename Scalar>
[[gnu::always_inline]] inline Advance<Scalar> advance(const GuardBounds<Scalar>& largest,
                                                      Scalar target, Scalar value,
                                                      Scalar last_step) {
  const Scalar wanted = std::isfinite(target) ? target : value;
  const Scalar goal = std::clamp(wanted, -largest.value, largest.value);
  const Scalar distance = goal - value;
  const Scalar reach = std::min(braking_step(std::abs(distance), largest.change), largest.step);
  Scalar step = distance < Scalar(0) ? -reach : reach;
  step = std::clamp(step, last_step - largest.change, last_step + largest.change);
  const bool is_short = step != distance;
  const Scalar next = is_short ? std::clamp(value + step, -largest.value, largest.value) : goal;
  return {next, next - value, goal != wanted, is_short};
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
  bounds_.value = limits.value - unit;
  bounds_.change = change - Scalar(2) * unit;
  bounds_.step = std::max(step - unit, step / Scalar(2));
  return Result::ok;
}

template <typename Scalar>
Scalar Guard<Scalar>::advance(Scalar target) {
  const Advance<Scalar> next = flexcomp::advance(bounds_, target, value_, step_);
  value_ = next.value;
  step_ = next.step;
  limited_by_value_ = next.limited_by_value;
  limited_by_rate_ = next.limited_by_rate;
  return value_;
}

template <typename Scalar, int Joints>
Result JointGuards<Scalar, Joints>::configure(
    const std::array<CorrectionLimits<Scalar>, Joints>& limits, Scalar period) {
  *this = JointGuards();
  for (std::size_t i = 0; i < Joints; ++i) {
    Guard<Scalar> guard;
    const Result result = guard.configure(limits[i], period);
    if (result != Result::ok) {
      return result;
    }
    largest_value_[i] = guard.bounds().value;
    largest_step_[i] = guard.bounds().step;
    largest_change_[i] = guard.bounds().change;
  }
  return Result::ok;
}

template <typename Scalar, int Joints>
JointVector<Scalar, Joints> JointGuards<Scalar, Joints>::advance(const Angles& targets) {
  limited_by_value_ = false;
  limited_by_rate_ = false;
  Angles values;
  for (std::size_t i = 0; i < Joints; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const GuardBounds<Scalar> bounds = {largest_value_[i], largest_step_[i], largest_change_[i]};
    const Advance<Scalar> next = flexcomp::advance(bounds, targets[joint], value_[i], step_[i]);
    value_[i] = next.value;
    step_[i] = next.step;
    values[joint] = next.value;
    limited_by_value_ = limited_by_value_ || next.limited_by_value;
    limited_by_rate_ = limited_by_rate_ || next.limited_by_rate;
  }
  return values;
}

#ifdef FLEXCOMP_VECTOR_REGISTERS

/// Line by line what `advance` does for one joint.
template <>
JointVector<float, 6> JointGuards<float, 6>::advance(const Angles& targets) {
  using Six = PackedSix<float>;
  const Six zero;
  const Six most = Six::read(largest_value_.data());
  const Six change = Six::read(largest_change_.data());
  const Six value = Six::read(value_.data());
  const Six last = Six::read(step_.data());
  const Six target(targets);
  const Six wanted = Six::choose(target.are_finite(), target, value);
  const Six goal = Six::smaller(most, Six::larger(-most, wanted));
  const Six distance = goal - value;
  Six braking = distance.magnitudes();
  if ((braking > kPlanned<float> * change).any()) {
    Angles steps = braking.numbers();
    for (std::size_t i = 0; i < 6; ++i) {
      float& step = steps[static_cast<Eigen::Index>(i)];
      step = braking_step(step, largest_change_[i]);
    }
    braking = Six(steps);
  }
  const Six reach = Six::smaller(Six::read(largest_step_.data()), braking);
  Six step = Six::choose(distance < zero, -reach, reach);
  step = Six::smaller(last + change, Six::larger(last - change, step));
  const auto are_short = step != distance;
  const Six halted = Six::smaller(most, Six::larger(-most, value + step));
  const Six next = Six::choose(are_short, halted, goal);
  const Six made = next - value;
  next.write(value_.data());
  made.write(step_.data());
  limited_by_value_ = (goal != wanted).any();
  limited_by_rate_ = are_short.any();
  return next.numbers();
}

#endif

template class Guard<float>;
template class Guard<double>;

#define FLEXCOMP_JOINT_GUARDS(Scalar, Joints) template class JointGuards<Scalar, Joints>;
FLEXCOMP_INSTANTIATE(FLEXCOMP_JOINT_GUARDS)

}  // namespace flexcomp
