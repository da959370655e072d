#pragma once

#include <functional>
#include <optional>

#include "linux/exchange.hpp"
#include "linux/lcm_link.hpp"
#include "linux/options.hpp"
#include "linux/slot_files.hpp"

namespace flexcomp {

/// What the real-time thread must not do: signals, LCM, checking and keeping tables, statistics.
class Service {
 public:
  /// `reread`: the options again, from the same command line; nothing if they are unusable now.
  Service(const Options& options, std::function<std::optional<Options>()> reread,
          Channel<ToRealTime>* to_real_time, Channel<FromRealTime>* from_real_time);

  /// Blocks the signals it serves, for this thread and those it starts. Call it before any.
  static void block_signals();

  /// Serves until the real-time thread has ended.
  void run();

 private:
  void on_signal();
  void on_real_time();
  void check(const TableReceived& received);
  void keep() const;
  void report(const Snapshot& snapshot) const;

  Options options_;
  std::function<std::optional<Options>()> reread_;
  Channel<ToRealTime>* to_real_time_;
  Channel<FromRealTime>* from_real_time_;
  std::optional<LcmLink> lcm_;
  FileDescriptor signals_;
  TableReceived received_;
  bool ended_ = false;
};

}  // namespace flexcomp
