#pragma once

#include <array>
#include <type_traits>

#include "node/node_settings.hpp"

namespace flexcomp {

/// Values that a number of the settings may have; never "not a number".
enum class SettingRange : std::uint8_t { any, above_zero, zero_or_above, zero_to_one, up_to_six };

template <typename Number>
constexpr bool is_in_range(Number value, SettingRange range) {
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
  return value == value;  // NOLINT(misc-redundant-expression): false for what is no number
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

template <typename Visitor, typename About, typename Vector>
[[gnu::always_inline]] inline void visit_joints(Visitor& visit, About about, Vector& numbers) {
  visit(about, JointNumbers<std::remove_reference_t<decltype(numbers[0])>>{
                   &numbers[0], &numbers[1], &numbers[2], &numbers[3], &numbers[4], &numbers[5]});
}

template <typename Visitor, typename About, typename Limits, typename Member>
[[gnu::always_inline]] inline void visit_limits(Visitor& visit, About about, Limits& limits,
                                                Member member) {
  using Number = std::remove_reference_t<decltype(limits[0].*member)>;
  visit(about,
        JointNumbers<Number>{&(limits[0].*member), &(limits[1].*member), &(limits[2].*member),
                             &(limits[3].*member), &(limits[4].*member), &(limits[5].*member)});
}

#define FLEXCOMP_SETTING(...) [] { return SettingNumber{__VA_ARGS__}; }

/// Shows `visit` every number of the settings, `const` where the settings are, in the order of the
/// settings record, and before it a function that returns its SettingNumber, so that a program
/// which does not call it (the microcontroller's) holds no text. It is the one list from which that
/// record, its reader, the options of `flexcompd` and the check of their ranges are made. A new
/// number goes to the end, and makes a new version of the record.
template <typename Settings, typename Visitor>
[[gnu::always_inline]] inline void visit_numbers(Settings* settings, Visitor&& visit) {
  using Range = SettingRange;
  auto& node = settings->node;
  auto& core = node.compensator;
  using Limits = std::decay_t<decltype(core.limits[0])>;
  visit(FLEXCOMP_SETTING("ready-ticks", "good inputs in a row before arming", Range::any),
        &core.ready_ticks);
  visit(FLEXCOMP_SETTING("late-ticks", "late ticks, beyond those on time, that are a fault",
                         Range::above_zero),
        &node.late_ticks);
  visit(FLEXCOMP_SETTING("tolerated-losses", "messages in a row that may be lost without a break",
                         Range::up_to_six, true),
        &settings->tolerated_losses);
  visit(FLEXCOMP_SETTING("period", "s, from one tick to the next", Range::above_zero, true),
        &core.period);
  visit(FLEXCOMP_SETTING("gain", "share of the deflection that is corrected", Range::zero_to_one),
        &core.gain);
  visit(FLEXCOMP_SETTING("filter-cutoff", "Hz, low-pass on the wrench; 0: none",
                         Range::zero_or_above),
        &core.filter_cutoff);
  visit(FLEXCOMP_SETTING("force-range", "N, largest plausible", Range::above_zero),
        &core.force_range);
  visit(FLEXCOMP_SETTING("moment-range", "N m, largest plausible", Range::above_zero),
        &core.moment_range);
  visit(FLEXCOMP_SETTING("setpoint-age-limit", "s, beyond it one is stale", Range::above_zero),
        &core.setpoint_age_limit);
  visit(FLEXCOMP_SETTING("wrench-age-limit", "s, beyond it one is stale", Range::above_zero),
        &core.wrench_age_limit);
  visit_joints(visit,
               FLEXCOMP_SETTING("joint-speed", "rad/s, largest plausible", Range::above_zero),
               core.joint_speed);
  visit_limits(visit,
               FLEXCOMP_SETTING("correction-limit", "rad, largest correction; one or a joint each",
                                Range::above_zero),
               core.limits, &Limits::value);
  visit_limits(visit,
               FLEXCOMP_SETTING("correction-rate", "rad/s, of the correction", Range::above_zero),
               core.limits, &Limits::rate);
  visit_limits(
      visit,
      FLEXCOMP_SETTING("correction-acceleration", "rad/s^2, of the correction", Range::above_zero),
      core.limits, &Limits::acceleration);
  visit(FLEXCOMP_SETTING("deflection-limit", "m, largest correction at the TCP", Range::above_zero),
        &core.deflection_limit);
  visit(FLEXCOMP_SETTING("chart-margin", "rad, outside the table, over which the correction fades",
                         Range::above_zero),
        &core.chart_margin);
  visit(
      FLEXCOMP_SETTING("hold-time",
                       "s, a fault may last before fading out; bad ticks count up, good ones down",
                       Range::zero_or_above),
      &core.hold_time);
  visit(FLEXCOMP_SETTING("fade-time", "s, from nothing to full correction and back",
                         Range::zero_or_above),
        &core.fade_time);
  visit(FLEXCOMP_SETTING("deflection-warning", "m, predicted: remark", Range::above_zero),
        &node.deflection_warning);
  visit(FLEXCOMP_SETTING("deflection-error", "m, predicted: fault", Range::above_zero),
        &node.deflection_error);
  visit(FLEXCOMP_SETTING("heartbeat", "s, from one heartbeat to the next", Range::above_zero),
        &node.heartbeat_period);
  visit(FLEXCOMP_SETTING("force-rate", "N/s, largest plausible change", Range::above_zero),
        &node.wrench.force_rate);
  visit(FLEXCOMP_SETTING("moment-rate", "N m/s, largest plausible", Range::above_zero),
        &node.wrench.moment_rate);
  visit(FLEXCOMP_SETTING("wrench-stuck-time",
                         "s, the same wrench while the robot moves; 0: not checked",
                         Range::zero_or_above),
        &node.wrench.stuck_time);
}

#undef FLEXCOMP_SETTING

}  // namespace flexcomp
