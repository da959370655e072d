#pragma once

#include <sys/eventfd.h>

#include <atomic>
#include <variant>

#include "linux/file_descriptor.hpp"
#include "node/node.hpp"
#include "node/ring.hpp"

namespace flexcomp {

/// A message from LCM with its sequence number.
struct LcmSample {
  Message message;
  std::uint32_t sequence = 0;
};

/// Result of checking a table that was received.
struct Verdict {
  std::uint32_t transfer = 0;  ///< TableReceived::transfer
  Reply refused = Reply::ok;   ///< by whom it comes from; else:
  Result opened = Result::no_table;
  Table table;
};

struct SnapshotRequest {};

/// Every statistic by its name; `exists` tells which are there.
struct Snapshot {
  std::array<std::uint64_t, 128> value{};
  std::array<bool, 128> exists{};
};

/// A transfer is complete: check the table, which stays as it is until the verdict, or until the
/// real-time thread has waited too long for one.
struct TableReceived {
  std::uint32_t transfer = 0;  ///< counts them
  const void* data = nullptr;
  std::size_t size = 0;
  IndexMemory index;  ///< the real-time thread does not touch it before the verdict
};

/// The table of this transfer has been put to use.
struct TableInUse {
  std::uint32_t transfer = 0;
};

/// The node has run with the table of this transfer (TableTrial); 0 for the table at start.
struct TableHasRun {
  std::uint32_t transfer = 0;
};

/// Faults that have made the correction fade out, and are latched until a reset.
struct FaultsLatched {
  std::uint32_t faults = 0;       ///< bits of the compensator
  std::uint16_t node_faults = 0;  ///< bits of the node
};

struct ConfigResult {
  Result result = Result::ok;
};

using ToRealTime = std::variant<std::monostate, SnapshotRequest, NodeConfig, Verdict>;
using FromRealTime = std::variant<std::monostate, TableReceived, TableInUse, TableHasRun,
                                  FaultsLatched, ConfigResult, Snapshot>;

/// One direction between two threads: a queue, and a descriptor that wakes the receiver.
template <typename Item>
class Channel {
 public:
  Channel() : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

  /// False if the queue is full; the item is then dropped.
  bool send(const Item& item) {
    const bool sent = ring_.push(item);
    wake();
    return sent;
  }

  bool receive(Item* item) { return ring_.pop(item); }

  void wake() { eventfd_write(event_.number(), 1); }

  /// Readable while something may be in the queue; `clear` before emptying it.
  int number() const { return event_.number(); }
  void clear() {
    eventfd_t count = 0;
    eventfd_read(event_.number(), &count);
  }

 private:
  Ring<Item, 256> ring_;
  FileDescriptor event_;
};

/// All that the real-time thread and the one that serves the outside share.
///
/// Messages of LCM may come faster than they are taken and are then dropped; they have queues of
/// their own, so that nothing else is. What the two ask each other is answered one at a time, which
/// leaves the other queues nearly empty. To stop, and that it has, are no messages: they cannot be
/// lost.
class Exchange {
 public:
  Channel<ToRealTime> to_real_time;
  Channel<FromRealTime> from_real_time;
  Channel<LcmSample> lcm_received;
  Channel<Message> lcm_to_send;

  /// Asks the real-time thread to fade to zero and end.
  void stop() {
    stop_.store(true, std::memory_order_release);
    to_real_time.wake();
  }
  bool is_to_stop() const { return stop_.load(std::memory_order_acquire); }

  /// The real-time thread has ended, and has sent all that it will.
  void end() {
    ended_.store(true, std::memory_order_release);
    from_real_time.wake();
  }
  bool has_ended() const { return ended_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<bool> ended_{false};
};

}  // namespace flexcomp
