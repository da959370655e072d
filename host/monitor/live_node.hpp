#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexcomp/model.hpp"
#include "messages/messages.hpp"

namespace flexcomp::monitor {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A compensator as the bus shows it at one moment. What was not heard is NaN, zero or empty.
struct Snapshot {
  double time = 0;  ///< s, since listening began
  /// An answer or a heartbeat came within the last second; else all below is what it was.
  bool is_heard = false;
  std::string state;                  ///< in words; empty before the first
  std::vector<std::string> faults;    ///< in words, of the last answer
  std::vector<std::string> remarks;   ///< the same
  std::vector<std::string> latched;   ///< what led to the last fade-out, until a reset
  JointAngles setpoint = filled();    ///< rad, uncorrected
  JointAngles correction = filled();  ///< rad
  /// Deflection of the joint springs (rad) and the TCP (m, rad; base frame), if the model is known:
  /// under the wrench on the bus and the weights in the model.
  JointAngles windup = filled();
  std::array<double, 6> tcp = filled();
  std::array<double, 6> wrench = filled();  ///< N, N·m
  std::uint64_t setpoints = 0;              ///< heard
  std::uint64_t unanswered = 0;             ///< of them, when the next one came
  double rate = 0;                          ///< setpoints a second, over the last second
  /// From a setpoint to its answer as they arrive here, over the last second, s.
  double mean_latency = kUnknown;
  double largest_latency = kUnknown;
  std::optional<HeartbeatMessage> heartbeat;         ///< the last
  std::map<std::uint8_t, std::uint64_t> statistics;  ///< by StatisticName, where it was asked
  std::uint64_t lost_messages = 0;                   ///< by gaps in their counters
  std::uint64_t damaged_messages = 0;                ///< checksum, length, or a part missing

  static constexpr std::array<double, 6> filled() {
    return {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  }
};

/// Listens to a bus and says at any time how the compensator on it is.
class LiveNode {
 public:
  /// `now`: ns, of a clock that only grows, as in all that follows. `model`: of the robot, for what
  /// its springs give, or none.
  LiveNode(std::int64_t now, std::optional<RobotModel<double, 6>> model)
      : began_(now), model_(std::move(model)) {}

  void take(const Message& message, std::int64_t now);

  Snapshot snapshot(std::int64_t now) const;

 private:
  /// A setpoint that was answered.
  struct Exchange {
    std::int64_t time;     ///< ns, of the answer
    std::int64_t latency;  ///< ns
  };

  void take_setpoint(const SetpointMessage& message, std::int64_t now);
  void take_answer(const CorrectedMessage& message, std::int64_t now);
  void add_latency(std::int64_t now, Snapshot* snapshot) const;
  void add_deflection(Snapshot* snapshot) const;

  std::int64_t began_;
  std::optional<RobotModel<double, 6>> model_;
  Snapshot last_;  ///< as far as messages alone say it
  std::optional<std::int64_t> heard_at_;
  std::optional<std::int64_t> open_since_;   ///< when the setpoint came that is not answered yet
  std::deque<std::int64_t> setpoint_times_;  ///< of the last second
  std::deque<Exchange> exchanges_;           ///< of the last second
};

}  // namespace flexcomp::monitor
