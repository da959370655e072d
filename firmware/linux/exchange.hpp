#pragma once

#include <sys/eventfd.h>

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

/// What came of checking a table that was received.
struct Verdict {
  Result opened = Result::no_table;
  Table table;
};

struct Stop {};
struct SnapshotRequest {};

/// Every statistic by its name; `exists` tells which are there.
struct Snapshot {
  std::array<std::uint64_t, 128> value{};
  std::array<bool, 128> exists{};
};

/// A transfer is complete: check the table, which stays as it is until the verdict.
struct TableReceived {
  const void* data = nullptr;
  std::size_t size = 0;
};

/// The table in this slot has been put to use: keep it.
struct TableInUse {
  std::size_t slot = 0;
};

struct ConfigResult {
  Result result = Result::ok;
};

struct Ended {};

using ToRealTime =
    std::variant<std::monostate, LcmSample, NodeConfig, Verdict, Stop, SnapshotRequest>;
using FromRealTime =
    std::variant<std::monostate, Message, TableReceived, TableInUse, ConfigResult, Snapshot, Ended>;

/// One direction between the real-time thread and the other: a queue, and a descriptor that wakes
/// the receiver.
template <typename Item>
class Channel {
 public:
  Channel() : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

  bool send(const Item& item) {
    const bool sent = ring_.push(item);
    eventfd_write(event_.number(), 1);
    return sent;
  }

  bool receive(Item* item) { return ring_.pop(item); }

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

}  // namespace flexcomp
