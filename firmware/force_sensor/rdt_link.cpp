#include "force_sensor/rdt_link.hpp"

#include "messages/digest.hpp"
#include "node/can_link.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kPatience = 500'000'000;  // ns

}  // namespace

void RdtLink::receive(std::string_view datagram, std::int64_t now) {
  RdtRecord record;
  if (!read_record(datagram, &record) || record.status != 0) {
    ++sequence_.counters.corrupt;
    return;
  }
  ask_at_ = now + kPatience;
  if (sequence_.accept(record.sequence, digest(datagram), now)) {
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
  const bool asks = now >= ask_at_;
  if (asks) {
    ask_at_ = now + kPatience;
  }
  return asks;
}

void RdtLink::add_to(LinkState* state) const {
  state->wrench = state->wrench + sequence_.counters;
  state->wrench_conflict |= sequence_.has_conflict();
}

}  // namespace flexcomp
