#include "monitor/view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "node/statistics.hpp"

namespace flexcomp::monitor {
namespace {

constexpr double kMicro = 1e6;
constexpr std::size_t kLabelWidth = 12;

std::string number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string("-");
}

std::string line(const char* label, const std::string& content) {
  return fmt::format("{:<{}}{}\n", label, kLabelWidth, content);
}

std::string listed(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::string state_line(const Snapshot& snapshot) {
  if (snapshot.state.empty()) {
    return line("state", "nobody is heard");
  }
  return line("state",
              snapshot.is_heard ? snapshot.state : snapshot.state + ", but not heard for a second");
}

std::string table_line(const HeartbeatMessage& beat) {
  if (beat.slot == 0) {
    return line("table", "none");
  }
  return line(
      "table",
      fmt::format("slot {}, robot {:016x}, largest safe gain {}", beat.slot, beat.table_model_hash,
                  beat.largest_gain > 0 ? number(beat.largest_gain, "{:.4g}") : "not analysed"));
}

std::string joint_lines(const Snapshot& snapshot) {
  std::string text = fmt::format("{:<{}}{:>14}{:>18}{:>18}\n", "joint", kLabelWidth, "setpoint rad",
                                 "correction µrad", "deflection µrad");
  for (std::size_t i = 0; i < snapshot.setpoint.size(); ++i) {
    text += fmt::format("{:<{}}{:>14}{:>18}{:>18}\n", i + 1, kLabelWidth,
                        number(snapshot.setpoint[i], "{:.5f}"),
                        number(kMicro * snapshot.correction[i], "{:.1f}"),
                        number(kMicro * snapshot.windup[i], "{:.1f}"));
  }
  return text;
}

std::string wrench_line(const Snapshot& snapshot) {
  const auto& w = snapshot.wrench;
  return line("wrench",
              fmt::format("{}, {}, {} N; {}, {}, {} N·m", number(w[0], "{:.1f}"),
                          number(w[1], "{:.1f}"), number(w[2], "{:.1f}"), number(w[3], "{:.2f}"),
                          number(w[4], "{:.2f}"), number(w[5], "{:.2f}")));
}

std::string tcp_line(const Snapshot& snapshot) {
  return line("TCP off by", fmt::format("{}, {}, {} µm without correction",
                                        number(kMicro * snapshot.tcp[0], "{:.0f}"),
                                        number(kMicro * snapshot.tcp[1], "{:.0f}"),
                                        number(kMicro * snapshot.tcp[2], "{:.0f}")));
}

std::uint64_t statistic(const Snapshot& snapshot, StatisticName name) {
  const auto found = snapshot.statistics.find(static_cast<std::uint8_t>(name));
  return found == snapshot.statistics.end() ? 0 : found->second;
}

/// The node's own account, where it was asked for.
std::string statistics_lines(const Snapshot& snapshot) {
  if (snapshot.statistics.empty()) {
    return "";
  }
  const auto of = [&](StatisticName name) { return statistic(snapshot, name); };
  return line("its ticks",
              fmt::format("{}, {} late", of(StatisticName::ticks), of(StatisticName::late_ticks))) +
         line("it heard",
              fmt::format("{} setpoints, {} lost, {} damaged", of(StatisticName::setpoint_received),
                          of(StatisticName::setpoint_lost), of(StatisticName::setpoint_corrupt))) +
         line("and",
              fmt::format("{} wrenches, {} lost, {} damaged", of(StatisticName::wrench_received),
                          of(StatisticName::wrench_lost), of(StatisticName::wrench_corrupt)));
}

/// A JSON number, or null.
nlohmann::ordered_json known(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json known(const std::array<double, 6>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double value : values) {
    list.push_back(known(value));
  }
  return list;
}

}  // namespace

std::string view(const Snapshot& snapshot) {
  std::string text = state_line(snapshot);
  text += line("faults", listed(snapshot.faults));
  text += line("remarks", listed(snapshot.remarks));
  text += line("latched", listed(snapshot.latched));
  if (snapshot.heartbeat) {
    text += table_line(*snapshot.heartbeat);
    text += line("uptime", fmt::format("{} s", snapshot.heartbeat->uptime));
  }
  text += joint_lines(snapshot);
  text += wrench_line(snapshot);
  text += tcp_line(snapshot);
  text += line("setpoints", fmt::format("{:.0f} a second; {} without an answer of {}",
                                        snapshot.rate, snapshot.unanswered, snapshot.setpoints));
  text += line("latency", fmt::format("{} ms on average, {} ms at most, in the last second",
                                      number(1e3 * snapshot.mean_latency, "{:.3f}"),
                                      number(1e3 * snapshot.largest_latency, "{:.3f}")));
  text += line("messages", fmt::format("{} lost, {} damaged, as heard here", snapshot.lost_messages,
                                       snapshot.damaged_messages));
  return text + statistics_lines(snapshot);
}

nlohmann::ordered_json to_json(const Snapshot& snapshot) {
  nlohmann::ordered_json json = {{"time", snapshot.time},
                                 {"heard", snapshot.is_heard},
                                 {"state", snapshot.state},
                                 {"faults", snapshot.faults},
                                 {"remarks", snapshot.remarks},
                                 {"latched", snapshot.latched},
                                 {"setpoint", known(snapshot.setpoint)},
                                 {"correction", known(snapshot.correction)},
                                 {"deflection", known(snapshot.windup)},
                                 {"tcp_deflection", known(snapshot.tcp)},
                                 {"wrench", known(snapshot.wrench)},
                                 {"setpoints", snapshot.setpoints},
                                 {"unanswered", snapshot.unanswered},
                                 {"rate", snapshot.rate},
                                 {"mean_latency", known(snapshot.mean_latency)},
                                 {"largest_latency", known(snapshot.largest_latency)},
                                 {"lost_messages", snapshot.lost_messages},
                                 {"damaged_messages", snapshot.damaged_messages}};
  if (snapshot.heartbeat) {
    json["uptime"] = snapshot.heartbeat->uptime;
    json["slot"] = snapshot.heartbeat->slot;
    json["model_hash"] = fmt::format("{:016x}", snapshot.heartbeat->table_model_hash);
    json["largest_gain"] = known(snapshot.heartbeat->largest_gain);
  }
  for (const auto& [name, value] : snapshot.statistics) {
    json["statistics"][std::to_string(name)] = value;
  }
  return json;
}

}  // namespace flexcomp::monitor
