#pragma once

#include <array>
#include <type_traits>

#include "node/node_settings.hpp"

namespace flexcomp {

/// Values that a number of the settings may have; never "not a number".
enum class SettingRange : std::uint8_t { any, above_zero, zero_or_above, zero_to_one, up_to_six };

constexpr bool is_in_range(double value, SettingRange range) {
  switch (range) {
    case SettingRange::any:
      break;
    case SettingRange::above_zero:
      return value > 0;
    case SettingRange::zero_or_above:
      return value >= 0;
    case SettingRange::zero_to_one:
      return value >= 0 && value <= 1;
    case SettingRange::up_to_six:
      return value >= 0 && value <= 6;
  }
  return value == value;
}

/// A number of the settings as `flexcompd` offers it.
struct SettingNumber {
  const char* name;  ///< of its option, without the dashes
  const char* help;
  SettingRange range;
  bool only_at_start = false;
};

/// One number for each joint.
template <typename Number>
using JointNumbers = std::array<Number*, 6>;

template <typename Visitor, typename Vector>
[[gnu::always_inline]] inline void visit_joints(Visitor& visit, const SettingNumber& number,
                                                Vector& numbers) {
  visit(number, JointNumbers<std::remove_reference_t<decltype(numbers[0])>>{
                    &numbers[0], &numbers[1], &numbers[2], &numbers[3], &numbers[4], &numbers[5]});
}

template <typename Visitor, typename Limits, typename Member>
[[gnu::always_inline]] inline void visit_limits(Visitor& visit, const SettingNumber& number,
                                                Limits& limits, Member member) {
  using Number = std::remove_reference_t<decltype(limits[0].*member)>;
  visit(number,
        JointNumbers<Number>{&(limits[0].*member), &(limits[1].*member), &(limits[2].*member),
                             &(limits[3].*member), &(limits[4].*member), &(limits[5].*member)});
}

/// Shows `visit` every number of the settings, `const` where the settings are, in the order of the
/// settings record: the one list from which that record, its reader, the options of `flexcompd` and
/// the check of their ranges are made. A new number goes to the end, and makes a new version of the
/// record.
template <typename Settings, typename Visitor>
[[gnu::always_inline]] inline void visit_numbers(Settings* settings, Visitor&& visit) {
  using Range = SettingRange;
  auto& node = settings->node;
  auto& core = node.compensator;
  using Limits = std::decay_t<decltype(core.limits[0])>;
  visit({"ready-ticks", "good inputs in a row before arming", Range::any}, &core.ready_ticks);
  visit({"late-ticks", "late ticks, beyond those on time, that are a fault", Range::above_zero},
        &node.late_ticks);
  visit({"tolerated-losses", "messages in a row that may be lost without a break", Range::up_to_six,
         true},
        &settings->tolerated_losses);
  visit({"period", "s, from one tick to the next", Range::above_zero, true}, &core.period);
  visit({"gain", "share of the deflection that is corrected", Range::zero_to_one}, &core.gain);
  visit({"filter-cutoff", "Hz, low-pass on the wrench; 0: none", Range::zero_or_above},
        &core.filter_cutoff);
  visit({"force-range", "N, largest plausible", Range::above_zero}, &core.force_range);
  visit({"moment-range", "N m, largest plausible", Range::above_zero}, &core.moment_range);
  visit({"setpoint-age-limit", "s, beyond it one is stale", Range::above_zero},
        &core.setpoint_age_limit);
  visit({"wrench-age-limit", "s, beyond it one is stale", Range::above_zero},
        &core.wrench_age_limit);
  visit_joints(visit, {"joint-speed", "rad/s, largest plausible", Range::above_zero},
               core.joint_speed);
  visit_limits(
      visit,
      {"correction-limit", "rad, largest correction; one or a joint each", Range::above_zero},
      core.limits, &Limits::value);
  visit_limits(visit, {"correction-rate", "rad/s, of the correction", Range::above_zero},
               core.limits, &Limits::rate);
  visit_limits(visit, {"correction-acceleration", "rad/s^2, of the correction", Range::above_zero},
               core.limits, &Limits::acceleration);
  visit({"deflection-limit", "m, largest correction at the TCP", Range::above_zero},
        &core.deflection_limit);
  visit({"chart-margin", "rad, outside the table, over which the correction fades",
         Range::above_zero},
        &core.chart_margin);
  visit({"hold-time", "s, a fault may last before fading out; bad ticks count up, good ones down",
         Range::zero_or_above},
        &core.hold_time);
  visit({"fade-time", "s, from nothing to full correction and back", Range::zero_or_above},
        &core.fade_time);
  visit({"deflection-warning", "m, predicted: remark", Range::above_zero},
        &node.deflection_warning);
  visit({"deflection-error", "m, predicted: fault", Range::above_zero}, &node.deflection_error);
  visit({"heartbeat", "s, from one heartbeat to the next", Range::above_zero},
        &node.heartbeat_period);
  visit({"force-rate", "N/s, largest plausible change", Range::above_zero},
        &node.wrench.force_rate);
  visit({"moment-rate", "N m/s, largest plausible", Range::above_zero}, &node.wrench.moment_rate);
  visit({"wrench-stuck-time", "s, the same wrench while the robot moves; 0: not checked",
         Range::zero_or_above},
        &node.wrench.stuck_time);
}

}  // namespace flexcomp
