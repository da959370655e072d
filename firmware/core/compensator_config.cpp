#include <cmath>

#include "checked_number.hpp"
#include "flexcomp/compensator.hpp"
#include "instantiate.hpp"
#include "packed_six.hpp"

namespace flexcomp {
namespace {

/// A positive number whose square is one, too.
template <typename Scalar>
bool is_range(Scalar value) {
  return is_positive(value) && is_positive(value * value);
}

/// Is a time at least zero, and at most so many periods?
template <typename Scalar>
bool lasts(Scalar time, Scalar period, Scalar most) {
  const Scalar count = std::ceil(time / period);
  return count >= Scalar(0) && count <= most;
}

/// The first of the members that are counted in periods which cannot be with this period, or null.
template <typename Scalar, int Joints>
const char* unusable_in_periods(const CompensatorConfig<Scalar, Joints>& config, Scalar period) {
  constexpr Scalar kMostHoldTicks = Scalar(1e9);  // what a counter holds
  // Steps much smaller than this would be lost to the rounding of a float near 1: no fade would
  // end.
  constexpr Scalar kMostFadeTicks = Scalar(1e6);
  if (!lasts(config.hold_time, period, kMostHoldTicks)) {
    return "hold_time";
  }
  if (!lasts(config.fade_time, period, kMostFadeTicks)) {
    return "fade_time";
  }
  JointGuards<Scalar, Joints> guards;
  return guards.configure(config.limits, period) == Result::ok ? nullptr : "limits";
}

/// Is a period such as no control loop has?
template <typename Scalar>
bool is_unusual(Scalar period) {
  return period < Scalar(1e-4) || period > Scalar(1);
}

}  // namespace

template <typename Scalar, int Joints>
const char* unusable_member(const CompensatorConfig<Scalar, Joints>& config) {
  const char* const own = first_unusable<10>({{
      {is_positive(config.period), "period"},
      {is_positive(config.gain) && config.gain <= Scalar(1), "gain"},
      {std::isfinite(config.filter_cutoff) && config.filter_cutoff >= Scalar(0), "filter_cutoff"},
      {is_range(config.force_range), "force_range"},
      {is_range(config.moment_range), "moment_range"},
      {is_positive(config.setpoint_age_limit), "setpoint_age_limit"},
      {is_positive(config.wrench_age_limit), "wrench_age_limit"},
      {PackedSix<Scalar>(config.joint_speed).is_finite() &&
           config.joint_speed.minCoeff() > Scalar(0),
       "joint_speed"},
      {is_positive(config.deflection_limit), "deflection_limit"},
      {is_positive(config.chart_margin), "chart_margin"},
  }});
  if (own != nullptr) {
    return own;
  }
  const char* const member = unusable_in_periods(config, config.period);
  const bool period_is_at_fault = member != nullptr && is_unusual(config.period) &&
                                  unusable_in_periods(config, Scalar(1e-3)) == nullptr;
  return period_is_at_fault ? "period" : member;
}

#define FLEXCOMP_UNUSABLE_MEMBER(Scalar, Joints) \
  template const char* unusable_member(const CompensatorConfig<Scalar, Joints>&);
FLEXCOMP_INSTANTIATE(FLEXCOMP_UNUSABLE_MEMBER)

}  // namespace flexcomp
