#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "messages/authentication_key.hpp"
#include "node/node.hpp"

namespace flexcomp {

/// Cause of a tick. The numbers are stable: they stand in settings records.
enum class Trigger : std::uint8_t {
  setpoint = 0,  ///< a setpoint, at most one a period; without one, the end of the period
  clock = 1,     ///< the period alone
  lockstep = 2,  ///< every setpoint, however fast they come; time is counted in periods
};

/// All that a node is told before it starts.
struct NodeSettings {
  NodeConfig node;
  Trigger trigger = Trigger::setpoint;
  std::uint32_t tolerated_losses = 3;  ///< messages in a row that may be lost without a break
  std::optional<AuthenticationKey> table_key = std::nullopt;  ///< takes only tables signed with it
};

/// The settings as they stand in a microcontroller's flash: little-endian 32-bit words and floats.
/// Written by `flexcompd --settings-out`.
struct SettingsRecord {
  std::uint32_t magic;
  std::uint32_t version;
  std::uint32_t size;  ///< bytes of the whole record
  std::uint32_t crc;   ///< CRC-32 (IEEE 802.3) of all that follows this word
  std::uint32_t model_hash_low;
  std::uint32_t model_hash_high;
  std::uint32_t trigger;
  std::uint32_t flags;  ///< bits: 1 identity required, 2 time stamps are used, 4 has a key
  std::array<std::uint32_t, 44> numbers;  ///< `visit_numbers` in its order, floats by their bits
  AuthenticationKey table_key;            ///< zero without one
};

/// Is each number one of those that it may be (settings_numbers.hpp)?
bool numbers_are_in_range(const NodeSettings& settings);

SettingsRecord to_record(const NodeSettings& settings);

/// Reads a record of `size` bytes, or the one that begins there if there are more. Returns ok, or
/// bad_config with `settings` untouched: not a record, of another version, damaged, or with numbers
/// that no node takes (`Node::configure`).
Result read_record(const void* data, std::size_t size, NodeSettings* settings);

}  // namespace flexcomp
