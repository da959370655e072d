#include "linux/statistics_file.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace flexcomp {
namespace {

constexpr std::array<const char*, 8> kStreamNames = {
    "received",        "lost",          "repeated", "old",
    "out_of_sequence", "contradicting", "corrupt",  "incomplete"};

std::uint64_t value(const Snapshot& snapshot, StatisticName name, std::size_t offset = 0) {
  return snapshot.value[static_cast<std::size_t>(name) + offset];
}

std::string stream_json(const Snapshot& snapshot, StatisticName first) {
  std::string text;
  for (std::size_t i = 0; i < kStreamNames.size(); ++i) {
    text +=
        fmt::format("{}\"{}\": {}", i == 0 ? "" : ", ", kStreamNames[i], value(snapshot, first, i));
  }
  return text;
}

}  // namespace

std::string statistics_json(const Snapshot& snapshot) {
  std::string latency;
  for (std::size_t bin = 0; bin < LatencyHistogram::kBins; ++bin) {
    latency +=
        fmt::format("{}{}", bin == 0 ? "" : ", ", value(snapshot, StatisticName::latency, bin));
  }
  constexpr std::array<std::pair<const char*, StatisticName>, 14> kNames = {{
      {"ticks", StatisticName::ticks},
      {"late_ticks", StatisticName::late_ticks},
      {"clock_jumps", StatisticName::clock_jumps},
      {"faults", StatisticName::faults},
      {"saturated_samples", StatisticName::saturated_samples},
      {"implausible_samples", StatisticName::implausible_samples},
      {"foreign_frames", StatisticName::foreign_frames},
      {"dropped_frames", StatisticName::dropped_frames},
      {"forged_messages", StatisticName::forged_messages},
      {"not_fresh_messages", StatisticName::not_fresh_messages},
      {"unauthenticated_messages", StatisticName::unauthenticated_messages},
      {"late_answers", StatisticName::late_answers},
      {"rsi_sessions", StatisticName::rsi_sessions},
      {"limited_answers", StatisticName::limited_answers},
  }};
  std::string text = "{\n";
  for (const auto& [name, number] : kNames) {
    if (!snapshot.exists[static_cast<std::size_t>(number)]) {
      continue;
    }
    text += fmt::format("  \"{}\": {},\n", name, value(snapshot, number));
  }
  text += fmt::format("  \"setpoint\": {{{}}},\n",
                      stream_json(snapshot, StatisticName::setpoint_received));
  text +=
      fmt::format("  \"wrench\": {{{}}},\n", stream_json(snapshot, StatisticName::wrench_received));
  text += fmt::format("  \"latency_log2_us\": [{}]\n}}\n", latency);
  return text;
}

std::string statistics_summary(const Snapshot& snapshot) {
  std::uint64_t answered = 0;
  for (std::size_t bin = 0; bin < LatencyHistogram::kBins; ++bin) {
    answered += value(snapshot, StatisticName::latency, bin);
  }
  std::uint64_t reached = 0;
  std::size_t bin = 0;
  while (bin + 1 < LatencyHistogram::kBins) {
    reached += value(snapshot, StatisticName::latency, bin);
    if (1000 * reached >= 999 * answered) {
      break;
    }
    ++bin;
  }
  return fmt::format(
      "flexcompd: {} ticks, {} late; setpoints: {} received, {} lost, {} corrupt; wrenches: {} "
      "received, {} lost, {} corrupt;\n"
      "flexcompd: {} setpoints answered, 99.9 % within {} us; {} frames not sent\n",
      value(snapshot, StatisticName::ticks), value(snapshot, StatisticName::late_ticks),
      value(snapshot, StatisticName::setpoint_received),
      value(snapshot, StatisticName::setpoint_lost),
      value(snapshot, StatisticName::setpoint_corrupt),
      value(snapshot, StatisticName::wrench_received), value(snapshot, StatisticName::wrench_lost),
      value(snapshot, StatisticName::wrench_corrupt), answered, std::uint64_t{2} << bin,
      value(snapshot, StatisticName::dropped_frames));
}

}  // namespace flexcomp
