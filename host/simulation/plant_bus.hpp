#pragma once

#include <memory>
#include <string>

#include "messages/messages.hpp"
#include "node/node.hpp"

namespace flexcomp::simulation {

/// Messages that did not arrive whole, of all senders together.
struct BusCounts {
  std::uint64_t lost = 0;     ///< by gaps in their counters
  std::uint64_t damaged = 0;  ///< checksum or length wrong, or a part missing
};

/// The bus as the plant sees it: messages to the compensator and back.
class PlantBus {
 public:
  virtual ~PlantBus() = default;
  PlantBus() = default;
  PlantBus(const PlantBus&) = delete;
  PlantBus& operator=(const PlantBus&) = delete;

  virtual void send(const Message& message) = 0;

  /// The next message that has come, waiting up to `patience` (ns) for one; false if none has.
  virtual bool receive(Message* message, std::int64_t patience) = 0;

  /// Losses since it was opened, as far as this bus can tell.
  virtual BusCounts counts() const { return {}; }
};

/// Opens "can:IFACE", "canfd:IFACE" or "lcm:URL". `key_file`: authenticate messages on CAN with the
/// key there, or empty. Throws InputError, naming the address or the file.
std::unique_ptr<PlantBus> open_plant_bus(const std::string& address, const std::string& key_file);

/// A node of its own inside this process, on a bus in memory: the same code and the same frames as
/// on a wire, in lock-step. The table must outlive it. Throws InputError if the node refuses it.
std::unique_ptr<PlantBus> make_inner_bus(const NodeConfig& config, const Table& table, bool fd);

}  // namespace flexcomp::simulation
