#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "flexcomp/path_index.hpp"
#include "messages/messages.hpp"

namespace flexcomp {

/// Memory for the index of one table (flexcomp/path_index.hpp), 4-byte aligned. A table whose index
/// does not fit goes without: long programs then take long to be found.
struct IndexMemory {
  std::uint32_t* words = nullptr;
  std::size_t capacity = 0;  ///< words

  /// For who has opened a table: makes its index.
  void index(Table* table) const { index_path(words, capacity * sizeof(std::uint32_t), table); }
};

/// Memory for one table, 4-byte aligned.
struct TableSlot {
  std::uint32_t* words = nullptr;
  std::size_t capacity = 0;  ///< words
  IndexMemory index{};
};

/// Two slots for tables: one in use, the other to receive the next, so that a transfer that fails
/// leaves the table in use alone.
///
/// A transfer is: begin, data in order, end. What has arrived is then to be checked as a whole
/// (`received`), which takes a pass over its bytes and so happens outside the tick, and put to use
/// or not.
class TableStore {
 public:
  void use_memory(TableSlot first, TableSlot second) { slots_ = {first, second}; }

  Reply begin(const TransferBeginMessage& message);
  Reply add(const TransferDataMessage& message);
  Reply end(const TransferEndMessage& message);
  std::uint32_t words_received() const { return received_; }

  /// The bytes of the slot that receives, once a transfer is complete; null before.
  const void* received(std::size_t* size) const;
  /// For the index of what was received.
  IndexMemory index_of_received() const { return slots_[receiving_slot()].index; }

  /// Ends the check of what was received. If it is to be used its slot becomes the one in use, with
  /// a table of `size` bytes in it; with 0 it is not.
  void conclude(std::size_t size);

  /// Puts a table to use that stands in a slot (0 or 1) or in fixed memory, at start.
  void use(std::size_t place, const void* table, std::size_t size);

  TableSlot slot(std::size_t index) const { return slots_[index]; }
  /// Where the table in use is: slot 0 or 1, kFixed or kNone.
  std::size_t active() const { return active_; }
  static constexpr std::size_t kFixed = 2;  ///< memory that nothing is received into, such as flash
  static constexpr std::size_t kNone = 3;

  /// Goes on with checking the CRC-32 of the table in use, a few bytes a call. False if a whole
  /// pass has found it damaged.
  bool scrub();

 private:
  enum class Phase : std::uint8_t { idle, receiving, complete };

  std::size_t receiving_slot() const { return active_ == 0 ? 1 : 0; }
  void restart_scrub();

  std::array<TableSlot, 2> slots_{};
  std::size_t active_ = kNone;
  Phase phase_ = Phase::idle;
  std::uint32_t words_ = 0;  ///< of the table on its way
  std::uint32_t crc_ = 0;    ///< that it was announced with
  std::uint32_t running_crc_ = 0;
  std::uint32_t received_ = 0;
  const unsigned char* in_use_ = nullptr;
  std::size_t scrub_size_ = 0;
  std::size_t scrub_place_ = 0;
  std::uint32_t scrub_crc_ = 0;
};

}  // namespace flexcomp
