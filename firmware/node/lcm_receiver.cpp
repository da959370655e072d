#include "node/lcm_receiver.hpp"

#include <cstring>

#include "node/can_link.hpp"

namespace flexcomp {
namespace {

constexpr std::uint32_t kCounter = 256;  // the low byte of the sequence is judged

/// FNV-1a over the numbers: tells contents apart, no more.
std::uint32_t digest(const std::array<double, 6>& numbers) {
  std::array<std::uint8_t, sizeof numbers> bytes{};
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  std::uint32_t hash = 2166136261U;
  for (const std::uint8_t byte : bytes) {
    hash = (hash ^ byte) * 16777619U;
  }
  return hash;
}

}  // namespace

LcmReceiver::LcmReceiver(std::uint32_t tolerated)
    : setpoint_(kCounter, tolerated), wrench_(kCounter, tolerated) {}

bool LcmReceiver::receive(const Message& message, std::uint32_t sequence, Node* node,
                          std::int64_t now) {
  if (const auto* setpoint = std::get_if<SetpointMessage>(&message)) {
    return setpoint_.accept(sequence, digest(setpoint->q), now) &&
           node->receive(message, Source::lcm, now);
  }
  const auto* wrench = std::get_if<WrenchMessage>(&message);
  if (wrench == nullptr || wrench_.accept(sequence, digest(wrench->wrench), now)) {
    node->receive(message, Source::lcm, now);
  }
  return false;
}

void LcmReceiver::add_to(LinkState* state) const {
  state->setpoint = state->setpoint + setpoint_.counters;
  state->wrench = state->wrench + wrench_.counters;
  state->setpoint_conflict |= setpoint_.has_conflict();
  state->wrench_conflict |= wrench_.has_conflict();
}

void LcmReceiver::forget_conflicts() {
  setpoint_.clear_conflict();
  wrench_.clear_conflict();
}

}  // namespace flexcomp
