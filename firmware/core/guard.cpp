#include "flexcomp/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "checked_number.hpp"
#include "instantiate.hpp"
#include "lanes.hpp"
#include "load_six.hpp"

namespace flexcomp {
namespace {

/// Share of the allowed deceleration that braking is planned with.
template <typename Scalar>
constexpr Scalar kPlanned = Scalar(31) / Scalar(32);

/// Largest step from which braking ends within `distance`, the step itself included; `change` is
/// the largest, and shorter than the distance.
template <typename Scalar>
Scalar braking_step(Scalar distance, Scalar change) {
  const Scalar d = distance / change;
  const Scalar whole = std::floor((std::sqrt(Scalar(1) + Scalar(8) * d) - Scalar(1)) / Scalar(2));
  const Scalar rest = d - whole * (whole + Scalar(1)) / Scalar(2);
  const Scalar fraction = std::clamp(rest / (whole + Scalar(1)), Scalar(0), Scalar(1));
  return (whole + fraction) * change;
}

/// Where a period takes a correction, or four side by side.
template <typename L>
struct Advance {
  typename L::Lane value;
  typename L::Lane step;
  typename L::Truth limited_by_value;
  typename L::Truth limited_by_rate;
};

/// Largest steps from which braking ends within the distances.
template <typename Scalar, typename L>
[[gnu::always_inline]] inline typename L::Lane braking_steps(typename L::Lane distance,
                                                             typename L::Lane largest_change) {
  // Planning with a little less than the allowed deceleration leaves room to absorb rounding.
  const typename L::Lane change = largest_change * kPlanned<Scalar>;
  const typename L::Truth is_near = distance <= change;
  if (L::all(is_near)) {
    return distance;
  }
  return L::choose(is_near, distance, L::apply(braking_step<Scalar>, distance, change));
}

/// Is no limit near: is the target within the largest value, and the way to it within the largest
/// step, what braking can take back and the largest change? Not where the target is no number.
template <typename Scalar, typename L, typename Lane = typename L::Lane>
[[gnu::always_inline]] inline bool is_ordinary(Lane largest_value, Lane largest_step,
                                               Lane largest_change, Lane target, Lane way,
                                               Lane last_step) {
  const Lane length = L::magnitude(way);
  const Lane planned = largest_change * kPlanned<Scalar>;
#ifdef FLEXCOMP_LARGER_IN_ONE_INSTRUCTION
  // One branch: the sign of a difference is exact, and with such a target none of them is a number.
  const Lane beyond = L::larger(
      L::larger(length - planned, length - largest_step),
      L::larger(L::magnitude(target) - largest_value,
                L::larger((last_step - largest_change) - way, way - (last_step + largest_change))));
  return L::all(beyond <= Scalar(0));
#else
  return L::all(length <= planned) &&
         L::all(L::both(
             L::both(length <= largest_step, L::magnitude(target) <= largest_value),
             L::both(way >= last_step - largest_change, way <= last_step + largest_change)));
#endif
}

#ifdef FLEXCOMP_LARGER_IN_ONE_INSTRUCTION
#define FLEXCOMP_SIX_GUARDS

/// Where six guards stand, in the order of `JointGuards`.
struct SixGuards {
  const float* largest_value;
  const float* largest_step;
  const float* largest_change;
  float* value;
  float* step;
};

/// `is_ordinary` of six joints with one branch: the sign of a difference is exact. If so moves them
/// all there.
[[gnu::always_inline]] inline bool take_ordinary_steps(const SixGuards& guards,
                                                       const float* targets) {
  using L = OneByOne<float>;
  float target[6], way[6], a[6], b[6];
  load_six<2>(targets, target);
  load_six<0>(guards.value, a);
  load_six<1>(guards.largest_change, b);
  float beyond = 0;
  float sum = 0;  // not a number if a target is none
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i) {
    way[i] = target[i] - a[i];
    const float length = L::magnitude(way[i]);
    const float too_far = length - b[i] * kPlanned<float>;
    sum = i > 0 ? sum + length : length;
    beyond = i > 0 ? L::larger(beyond, too_far) : too_far;
  }
  if (!(beyond <= 0)) {
    return false;  // as a rule where it is not ordinary: no more is lost than this
  }
  load_six<0>(guards.step, a);
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i) {
    beyond = L::larger(beyond, (a[i] - b[i]) - way[i]);
    beyond = L::larger(beyond, way[i] - (a[i] + b[i]));
  }
  load_six<0>(guards.largest_step, a);
  load_six<1>(guards.largest_value, b);
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i) {
    beyond = L::larger(beyond, L::magnitude(way[i]) - a[i]);
    beyond = L::larger(beyond, L::magnitude(target[i]) - b[i]);
  }
  if (!(beyond <= 0) || std::isnan(sum)) {
    return false;
  }
  store_six(target, guards.value);
  store_six(way, guards.step);
  return true;
}
#endif

/// One period of one number, or of four side by side. `Ordinary`: whether nothing but that is
/// looked for first.
template <typename Scalar, typename L, bool Ordinary = true, typename Lane = typename L::Lane>
[[gnu::always_inline]] inline Advance<L> advance(Lane largest_value, Lane largest_step,
                                                 Lane largest_change, Lane target, Lane value,
                                                 Lane last_step) {
  constexpr Scalar kLargest = std::numeric_limits<Scalar>::max();
  const auto smaller = [](Lane a, Lane b) { return L::choose(a < b, a, b); };
  const auto clamp = [&](Lane a, Lane low, Lane high) {
    return smaller(high, L::choose(low > a, low, a));
  };
  // Ordinary machining: no limit is near, and all that follows would come to this.
  const Lane way = target - value;
  if (Ordinary &&
      is_ordinary<Scalar, L>(largest_value, largest_step, largest_change, target, way, last_step)) {
    constexpr typename L::Truth kNone{};
    return {target, way, kNone, kNone};
  }
  const Lane wanted = L::choose(L::magnitude(target) <= kLargest, target, value);
  const Lane goal = clamp(wanted, -largest_value, largest_value);
  const Lane distance = goal - value;
  const Lane braking = braking_steps<Scalar, L>(L::magnitude(distance), largest_change);
  const Lane reach = smaller(largest_step, braking);
  Lane step = L::choose(distance < Scalar(0), -reach, reach);
  step = clamp(step, last_step - largest_change, last_step + largest_change);
  const auto is_short = step != distance;
  const Lane next =
      L::any(is_short)
          ? L::choose(is_short, clamp(value + step, -largest_value, largest_value), goal)
          : goal;
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
  const auto next = flexcomp::advance<Scalar, OneByOne<Scalar>>(
      bounds_.value, bounds_.step, bounds_.change, target, value_, step_);
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
  using L = std::conditional_t<Joints == 6, Lanes<Scalar>, OneByOne<Scalar>>;
  constexpr std::size_t kLanes = Joints == 6 ? L::kCount : static_cast<std::size_t>(Joints);
#ifdef FLEXCOMP_SIX_GUARDS
  constexpr bool kAtOnce = std::is_same_v<Scalar, float> && Joints == 6;
  if constexpr (kAtOnce) {
    if (take_ordinary_steps({largest_value_.data(), largest_step_.data(), largest_change_.data(),
                             value_.data(), step_.data()},
                            targets.data())) {
      limited_by_value_ = false;
      limited_by_rate_ = false;
      return targets;
    }
  }
#else
  constexpr bool kAtOnce = false;
#endif
  typename L::Truth limited_by_value{};
  typename L::Truth limited_by_rate{};
  Angles values;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const auto next = flexcomp::advance<Scalar, L, !kAtOnce>(
        L::load(largest_value_.data(), i), L::load(largest_step_.data(), i),
        L::load(largest_change_.data(), i), L::load(targets.data(), i), L::load(value_.data(), i),
        L::load(step_.data(), i));
    L::store(next.value, i, value_.data());
    L::store(next.step, i, step_.data());
    L::store(next.value, i, values.data());
    limited_by_value = L::either(limited_by_value, next.limited_by_value);
    limited_by_rate = L::either(limited_by_rate, next.limited_by_rate);
  }
  limited_by_value_ = L::any(limited_by_value);
  limited_by_rate_ = L::any(limited_by_rate);
  return values;
}

template class Guard<float>;
template class Guard<double>;

#define FLEXCOMP_JOINT_GUARDS(Scalar, Joints) template class JointGuards<Scalar, Joints>;
FLEXCOMP_INSTANTIATE_ARM(FLEXCOMP_JOINT_GUARDS)

}  // namespace flexcomp
