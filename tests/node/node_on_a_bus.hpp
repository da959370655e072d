#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "node/can_link.hpp"
#include "node/default_config.hpp"
#include "unity_main.hpp"

namespace flexcomp::test {

constexpr double kTurn = 6.28318530717958647692;

/// A table for the loop of `loop_angles`, as words.
inline std::vector<std::uint32_t> loop_table(const RobotModel<float, 6>& model,
                                             float largest_gain = 0) {
  std::vector<JointVector<float, 6>> program;
  for (int i = 0; i <= 120; ++i) {
    program.push_back(loop_angles<float>(kTurn * (i % 120) / 120));
  }
  std::vector<std::uint32_t> words(1 << 14);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(
      Result::ok, (build_path_table<float, 6>(model, program.data(), program.size(),
                                              {2000, 50, 5e-6F, 5e-6F, largest_gain}, words.data(),
                                              4 * words.size(), &size)));
  words.resize(size / 4);
  return words;
}

/// The table of most tests, built once.
inline const std::vector<std::uint32_t>& usual_table() {
  static const std::vector<std::uint32_t> kWords = loop_table(kr270<float>());
  return kWords;
}

inline NodeConfig usual_config() {
  NodeConfig config = default_node_config();
  config.compensator.model_hash = model_hash(kr270<float>());
  config.compensator.fade_time = 0.1F;
  return config;
}

/// Holds the corrections on the bus to value, rate and acceleration limits, from tick to tick.
class LimitsChecker {
 public:
  explicit LimitsChecker(const NodeConfig& config) : config_(config.compensator) {}

  void check(const CorrectedMessage& message) {
    if (!std::isfinite(message.corrected[0])) {
      return;  // no setpoint yet: the node says so instead of giving numbers
    }
    // Limits hold to a few units in the last place of the angles, which the difference has.
    constexpr double kRounding = 16 * 1.2e-7 * 3.2;
    const auto period = static_cast<double>(config_.period);
    for (std::size_t i = 0; i < 6; ++i) {
      const auto value = static_cast<double>(config_.limits[i].value);
      const double largest_step = static_cast<double>(config_.limits[i].rate) * period;
      const double largest_change =
          static_cast<double>(config_.limits[i].acceleration) * period * period;
      const double correction = message.corrected[i] - message.uncorrected[i];
      TEST_ASSERT_TRUE(std::isfinite(correction));
      const double step = correction - correction_[i];
      TEST_ASSERT_DOUBLE_WITHIN(value + kRounding, 0, correction);
      TEST_ASSERT_DOUBLE_WITHIN(largest_step + kRounding, 0, step);
      TEST_ASSERT_DOUBLE_WITHIN(largest_change + 2 * kRounding, step_[i], step);
      correction_[i] = correction;
      step_[i] = step;
    }
  }

  double largest_correction() const {
    double largest = 0;
    for (const double correction : correction_) {
      largest = std::max(largest, std::fabs(correction));
    }
    return largest;
  }

 private:
  CompensatorConfig<float, 6> config_;
  std::array<double, 6> correction_{};
  std::array<double, 6> step_{};
};

/// A node with its tables, a sender and a receiver of frames, and a clock that the test turns.
/// Every correction that it sends is held to the limits.
class NodeOnABus {
 public:
  explicit NodeOnABus(const NodeConfig& config = usual_config(),
                      const std::vector<std::uint32_t>& table = usual_table())
      : limits(config), config_(config), first_(1 << 14), second_(1 << 14) {
    node.use_memory({first_.data(), first_.size()}, {second_.data(), second_.size()});
    TEST_ASSERT_EQUAL(Result::ok, node.configure(config));
    std::copy(table.begin(), table.end(), first_.begin());
    Table opened;
    TEST_ASSERT_EQUAL(Result::ok, Table::open(first_.data(), 4 * table.size(), &opened));
    started_with = node.start_with(0, opened);
  }

  /// The sender's format; classic frames if not set.
  void use_fd(bool fd) { sender_ = CanEncoder(fd); }

  /// Frames that `message` becomes at the sender.
  FrameList encode(const Message& message) { return sender_.encode(message); }

  void put(const CanFrame& frame) { link.receive(frame, &node, now); }

  void put(const FrameList& list) {
    for (std::size_t i = 0; i < list.count; ++i) {
      put(list.frames[i]);
    }
  }

  void send(const Message& message) { put(encode(message)); }

  /// One period: the node ticks; what it sends is received.
  CorrectedMessage tick(std::int64_t elapsed = 4'000'000) {
    now += elapsed;
    if (node.take_reset()) {
      link.forget_conflicts();
    }
    LinkState state = link.state();
    state.bus_fault = bus_fault;
    state.authentication = authentication;
    node.set_link(state);
    const CorrectedMessage corrected = node.tick(now);
    limits.check(corrected);
    Message message;
    while (node.next_message(&message)) {
      if (const auto* reply = std::get_if<CommandReplyMessage>(&message)) {
        command_reply = *reply;
      } else if (const auto* transfer = std::get_if<TransferReplyMessage>(&message)) {
        transfer_reply = *transfer;
      } else if (const auto* fault = std::get_if<FaultMessage>(&message)) {
        faults.push_back(*fault);
      } else if (const auto* statistic = std::get_if<StatisticMessage>(&message)) {
        statistics.push_back(*statistic);
      } else if (const auto* beat = std::get_if<HeartbeatMessage>(&message)) {
        heartbeat = *beat;
      }
    }
    return corrected;
  }

  /// A setpoint and a wrench of ordinary machining, a little further on.
  SetpointMessage next_setpoint() {
    phase_ += kTurn / 3000;
    SetpointMessage message{now, {}};
    const JointVector<double, 6> q = loop_angles<double>(phase_);
    std::copy_n(q.data(), 6, message.q.begin());
    return message;
  }

  WrenchMessage next_wrench() {
    // The sensor's noise, without chance.
    const double noise = 3 * std::sin(1000 * phase_);
    return {now, {440 + noise, 1370 - noise, 635, 0, 3, 10.5}, false};
  }

  CorrectedMessage machine() {
    send(next_wrench());
    send(next_setpoint());
    return tick();
  }

  CorrectedMessage machine(int ticks) {
    CorrectedMessage last;
    for (int i = 0; i < ticks; ++i) {
      last = machine();
    }
    return last;
  }

  void announce() { send(IdentityMessage{config_.compensator.model_hash, WrenchFrame::base}); }

  std::uint8_t command(Command wanted) {
    send(CommandMessage{wanted});
    machine();
    TEST_ASSERT_EQUAL(wanted, command_reply.command);
    return command_reply.reply;
  }

  /// Makes it active.
  void bring_up() {
    announce();
    machine(20);
    TEST_ASSERT_EQUAL(0, command(Command::arm));
    machine(60);
    TEST_ASSERT_EQUAL(State::active, node.state());
  }

  bool has_announced(std::uint16_t code, bool began) const {
    for (const FaultMessage& fault : faults) {
      if (fault.code == code && fault.active == began) {
        return true;
      }
    }
    return false;
  }

  std::vector<std::uint32_t>& first_slot() { return first_; }
  std::vector<std::uint32_t>& second_slot() { return second_; }

  Node node;
  LimitsChecker limits;
  CanLink link{false, 3};
  bool bus_fault = false;
  AuthenticationCounters authentication;
  std::int64_t now = 1'000'000'000;
  Result started_with = Result::no_table;
  CommandReplyMessage command_reply;
  TransferReplyMessage transfer_reply;
  HeartbeatMessage heartbeat;
  std::vector<FaultMessage> faults;
  std::vector<StatisticMessage> statistics;

 private:
  NodeConfig config_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> second_;
  CanEncoder sender_;
  double phase_ = 0;
};

}  // namespace flexcomp::test
