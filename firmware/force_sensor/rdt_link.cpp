#include "force_sensor/rdt_link.hpp"

#include "node/can_link.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kAskAgain = 500'000'000;  // ns

/// Tells records apart that have one number in the stream.
std::uint32_t digest(const RdtRecord& record) {
  std::uint32_t all = record.sample;
  for (const std::int32_t counts : record.load) {
    all = all * 16777619U ^ static_cast<std::uint32_t>(counts);
  }
  return all;
}

}  // namespace

void RdtLink::receive(std::string_view datagram, std::int64_t now) {
  RdtRecord record;
  if (!read_record(datagram, &record) || record.status != 0) {
    ++sequence_.counters.corrupt;
    return;
  }
  received_at_ = now;
  if (sequence_.accept(record.sequence, digest(record), now)) {
    newest_ = record;
    has_newest_ = true;
  }
}

void RdtLink::hand_over(Node* node, std::int64_t now) {
  const JointAngles* q = node->setpoint();
  if (!has_newest_ || q == nullptr) {
    return;
  }
  has_newest_ = false;
  std::array<double, 6> load{};
  for (std::size_t i = 0; i < load.size(); ++i) {
    const double unit = i < 3 ? config_.counts_per_newton : config_.counts_per_newton_metre;
    load[i] = static_cast<double>(newest_.load[i]) / unit - config_.zero[i];
  }
  node->receive(WrenchMessage{kNoTime, wrench_at_tcp(config_.mounting, *q, load), false},
                Source::sensor, now);
}

bool RdtLink::wants_request(std::int64_t now) {
  const bool is_silent = now - received_at_ >= kAskAgain || received_at_ == 0;
  const bool asks = is_silent && (!asked_ || now - asked_at_ >= kAskAgain);
  if (asks) {
    asked_ = true;
    asked_at_ = now;
  }
  return asks;
}

void RdtLink::add_to(LinkState* state) const {
  state->wrench = state->wrench + sequence_.counters;
  state->wrench_conflict |= sequence_.has_conflict();
}

}  // namespace flexcomp
