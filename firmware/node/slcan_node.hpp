#pragma once

#include <atomic>

#include "messages/slcan.hpp"
#include "node/can_link.hpp"
#include "node/node_settings.hpp"
#include "node/ring.hpp"
#include "node/table_trial.hpp"

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

  /// Takes the table at the beginning of fixed memory of `size` bytes (flash), or says on the bus
  /// why not. Once, before the first step.
  void start_with(const void* memory, std::size_t size, IndexMemory index = {});

  /// One look at the line, and a tick if one is due; `now` in ns. Several times a period.
  void step(std::int64_t now);

  /// Tells the statistics how much of the stack was used; bytes, found by the main program.
  void set_stack_used(std::uint32_t bytes) { stack_used_.store(bytes, std::memory_order_relaxed); }

  /// For the main program, after each step: checks a table that has come over the bus, if there is
  /// one. With a key, tables are taken as TableAdmission says; the counter that never goes back
  /// lives in memory and begins anew with a reset, at that of the table in flash once it has run.
  void check_table();

 private:
  enum class Check : std::uint8_t { none, wanted, done };

  struct Checked {
    Reply refused = Reply::ok;  ///< by its signature; then it was not opened
    Result opened = Result::ok;
    Table table;
    std::uint32_t counter = 0;
  };

  Checked checked(const void* data, std::size_t size, IndexMemory index) const;
  void has_in_use(std::uint32_t counter);
  void take_bytes(std::int64_t now);
  void take_bytes(const std::uint8_t* bytes, std::size_t count, std::int64_t now);
  void take_frame(std::int64_t now);
  void on_setpoint(std::int64_t now);
  void tick(std::int64_t now);
  void exchange_tables();
  void report_link();
  template <typename SomeMessage>
  void send(const SomeMessage& message);
  void send_line(const SlcanLine& line);

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
  IndexMemory unchecked_index_;
  Checked checked_;

  std::optional<AuthenticationKey> table_key_;
  TableTrial trial_;
  std::uint32_t counter_in_use_ = 0;
  std::atomic<std::uint32_t> counter_run_{0};  ///< the highest of a table that has run
};

}  // namespace flexcomp
