#pragma once

#include <atomic>

#include "messages/slcan.hpp"
#include "node/can_link.hpp"
#include "node/node_settings.hpp"
#include "node/ring.hpp"

namespace flexcomp {

/// A node whose bus is a serial line that speaks SLCAN, for a microcontroller without an operating
/// system. Three run it: who drives the line fills `received` and empties `to_send`; a periodic
/// interrupt calls `step`; and the main program, which it interrupts, checks tables.
///
/// The channel is open from the start; commands that open it are answered and change nothing, so
/// that a reset of the processor needs no help from the other side.
class SlcanNode {
 public:
  using Bytes = Ring<std::uint8_t, 8192>;

  /// `received`, `to_send` and the memory for tables that come over the bus outlive the node. With
  /// settings that no node takes it runs all the same, says so on the bus, and cannot be armed.
  SlcanNode(const NodeSettings& settings, Bytes* received, Bytes* to_send, TableSlot first,
            TableSlot second);

  Node* node() { return &node_; }

  /// One look at the line, and a tick if one is due; `now` in ns. Several times a period.
  void step(std::int64_t now);

  /// What the main program found of the stack, for the statistics; bytes.
  void set_stack_used(std::uint32_t bytes) { stack_used_.store(bytes, std::memory_order_relaxed); }

  /// Is there a table to be checked (`Table::open`)? To be answered by `table_checked`.
  bool table_to_check(const void** data, std::size_t* size) const;
  void table_checked(Result opened, const Table& table);

 private:
  enum class Check : std::uint8_t { none, wanted, done };

  void take_bytes(std::int64_t now);
  void on_setpoint(std::int64_t now);
  void tick(std::int64_t now);
  void exchange_tables();
  LinkState link_state() const;
  void send(const Message& message);
  void send(const SlcanLine& line);

  Bytes* received_;
  Bytes* to_send_;
  Node node_;
  SlcanReader reader_;
  CanLink link_;
  Trigger trigger_;
  std::int64_t period_;  ///< ns
  std::int64_t ticked_at_ = 0;
  std::int64_t due_at_ = 0;        ///< ns, when there is a tick even without a setpoint
  std::int64_t steps_ = 0;         ///< of lock-step
  std::uint32_t other_lines_ = 0;  ///< frames of other kinds, and what is none
  std::uint32_t dropped_frames_ = 0;
  std::uint32_t lines_to_recover_ = 0;  ///< to be taken by the line before it counts as well again
  std::atomic<std::uint32_t> stack_used_{0};

  std::atomic<Check> check_{Check::none};
  const void* unchecked_ = nullptr;
  std::size_t unchecked_size_ = 0;
  Result opened_ = Result::ok;
  Table checked_;
};

}  // namespace flexcomp
