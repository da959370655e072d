#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "linux/background.hpp"
#include "linux/exchange.hpp"
#include "linux/lcm_link.hpp"
#include "linux/options.hpp"
#include "linux/slot_files.hpp"
#include "node/table_admission.hpp"

namespace flexcomp {

/// Does what the real-time thread must not: signals, LCM, checking tables. It waits for nothing but
/// the next of these: files and the terminal, which may stall, are the background's.
class Service {
 public:
  using Reread = std::function<std::optional<Options>()>;

  /// `reread`: the options again, from the same command line; nothing if they are unusable now. It
  /// may take long.
  /// With a key: `signed_tables` says which tables are taken, and `counter` is that of the table at
  /// start.
  Service(const Options& options, Reread reread, std::optional<TableAdmission> signed_tables,
          std::uint32_t counter, Exchange* exchange, Background* background);

  /// Signals that ask for something wait from now on until it runs. Those that end still end the
  /// process at once.
  static void hold_requests();

  /// Blocks all signals that it serves, for this thread and those it starts. Call it before any.
  static void block_signals();

  /// Serves until the real-time thread has ended. False if something failed here that must not:
  /// the real-time thread was then told to fade and end, as by a signal.
  bool run();

 private:
  void wait_and_serve();
  void on_signals();
  void on_real_time();
  void read_configuration();
  void on_configuration();
  void tell(const FaultsLatched& latched);
  void check(const TableReceived& received);
  Verdict judge(const TableReceived& received);
  void keep(const TableInUse& in_use);
  void confirm(const TableHasRun& has_run);
  void report(const Snapshot& snapshot);
  void wait_for_end();

  Options options_;
  Reread reread_;
  Exchange* exchange_;
  Background* background_;
  std::optional<LcmLink> lcm_;
  FileDescriptor signals_;
  /// From the background, which may outlive this. Nothing: they are unusable.
  std::shared_ptr<Channel<std::optional<NodeConfig>>> configurations_;
  bool reads_configuration_ = false;
  bool awaits_snapshot_ = false;
  std::optional<TableAdmission> signed_tables_;
  std::uint32_t counter_in_use_;
  std::shared_ptr<SlotFiles> slots_;  ///< null without a directory; used in the background alone
  std::uint32_t received_transfer_ = 0;
  std::uint32_t received_counter_ = 0;
  std::shared_ptr<const std::vector<char>> received_;  ///< a copy, which no transfer writes over
};

}  // namespace flexcomp
