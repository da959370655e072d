#include "monitor/live_node.hpp"

#include <algorithm>
#include <cmath>

#include "flexcomp/compensator.hpp"
#include "flexcomp/compliance.hpp"
#include "node/node_status.hpp"

namespace flexcomp::monitor {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

double seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

/// The bits of a status word under a mask, in words.
template <typename Bit>
void add_words(std::uint32_t status, std::uint32_t mask, std::vector<std::string>* words) {
  for (int place = 0; place < 32; ++place) {
    const std::uint32_t bit = std::uint32_t{1} << place;
    if ((status & mask & bit) != 0) {
      words->emplace_back(describe(static_cast<Bit>(bit)));
    }
  }
}

/// The bits of both status words under their masks.
std::vector<std::string> words(std::uint32_t status, std::uint32_t mask, std::uint16_t node_status,
                               std::uint16_t node_mask) {
  std::vector<std::string> all;
  add_words<StatusBit>(status, mask, &all);
  add_words<NodeBit>(node_status, node_mask, &all);
  return all;
}

bool is_finite(const std::array<double, 6>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace

void LiveNode::take(const Message& message, std::int64_t now) {
  if (const auto* setpoint = std::get_if<SetpointMessage>(&message)) {
    take_setpoint(*setpoint, now);
  } else if (const auto* corrected = std::get_if<CorrectedMessage>(&message)) {
    take_answer(*corrected, now);
  } else if (const auto* wrench = std::get_if<WrenchMessage>(&message)) {
    last_.wrench = wrench->wrench;
  } else if (const auto* statistic = std::get_if<StatisticMessage>(&message)) {
    last_.statistics[statistic->name] = statistic->value;
  } else if (const auto* heartbeat = std::get_if<HeartbeatMessage>(&message)) {
    heard_at_ = now;
    last_.heartbeat = *heartbeat;
    last_.state = describe(static_cast<State>(heartbeat->state));
    last_.latched = words(heartbeat->latched_faults, kFaultBits, heartbeat->node_latched_faults,
                          kNodeFaultBits);
  }
}

void LiveNode::take_setpoint(const SetpointMessage& message, std::int64_t now) {
  ++last_.setpoints;
  last_.unanswered += open_since_ ? 1U : 0U;
  open_since_ = now;
  last_.setpoint = message.q;
  setpoint_times_.push_back(now);
  while (setpoint_times_.front() <= now - kSecond) {
    setpoint_times_.pop_front();
  }
}

void LiveNode::take_answer(const CorrectedMessage& message, std::int64_t now) {
  heard_at_ = now;
  last_.state = describe(static_cast<State>(message.state));
  last_.faults = words(message.status, kFaultBits, message.node_status, kNodeFaultBits);
  last_.remarks = words(message.status, ~kFaultBits, message.node_status,
                        static_cast<std::uint16_t>(~kNodeFaultBits));
  for (std::size_t i = 0; i < last_.correction.size(); ++i) {
    last_.correction[i] = message.corrected[i] - message.uncorrected[i];
  }
  if (open_since_) {
    exchanges_.push_back({now, now - *open_since_});
    open_since_.reset();
  }
  while (!exchanges_.empty() && exchanges_.front().time <= now - kSecond) {
    exchanges_.pop_front();
  }
}

Snapshot LiveNode::snapshot(std::int64_t now) const {
  Snapshot snapshot = last_;
  snapshot.time = seconds(now - began_);
  snapshot.is_heard = heard_at_ && now - *heard_at_ < kSecond;
  snapshot.rate =
      static_cast<double>(std::count_if(setpoint_times_.begin(), setpoint_times_.end(),
                                        [now](std::int64_t time) { return time > now - kSecond; }));
  add_latency(now, &snapshot);
  add_deflection(&snapshot);
  return snapshot;
}

void LiveNode::add_latency(std::int64_t now, Snapshot* snapshot) const {
  std::int64_t sum = 0;
  std::int64_t largest = 0;
  std::int64_t count = 0;
  for (const Exchange& exchange : exchanges_) {
    if (exchange.time > now - kSecond) {
      sum += exchange.latency;
      largest = std::max(largest, exchange.latency);
      ++count;
    }
  }
  if (count > 0) {
    snapshot->mean_latency = seconds(sum) / static_cast<double>(count);
    snapshot->largest_latency = seconds(largest);
  }
}

void LiveNode::add_deflection(Snapshot* snapshot) const {
  if (!model_ || !is_finite(snapshot->setpoint) || !is_finite(snapshot->wrench)) {
    return;
  }
  using Six = Eigen::Map<const Twist<double>>;
  const Deflection<double, 6> given =
      deflection<double, 6>(*model_, Six(snapshot->setpoint.data()), Six(snapshot->wrench.data()));
  std::copy_n(given.windup.data(), 6, snapshot->windup.begin());
  std::copy_n(given.tcp.data(), 6, snapshot->tcp.begin());
}

}  // namespace flexcomp::monitor
