#pragma once

#include <array>
#include <utility>

#include "flexcomp/compensator.hpp"
#include "messages/authentication_counters.hpp"
#include "messages/messages.hpp"
#include "messages/second_sender.hpp"
#include "messages/sequence.hpp"
#include "node/node_status.hpp"
#include "node/refusal_watch.hpp"
#include "node/statistics.hpp"
#include "node/table_store.hpp"
#include "node/transport_delay.hpp"
#include "node/wrench_monitor.hpp"

namespace flexcomp {

struct NodeConfig {
  CompensatorConfig<float, 6> compensator;
  WrenchMonitorConfig wrench;
  bool require_identity = true;     ///< refuse to arm until the sender has named its robot
  double deflection_warning = 1e9;  ///< m, predicted: remark
  double deflection_error = 1e9;    ///< m, predicted: fault
  std::uint32_t late_ticks = 10;    ///< ticks late or early, beyond those on time, that are a fault
  double heartbeat_period = 0.1;    ///< s
  /// Ages from the senders' clocks too, where messages carry them; not where time is not real.
  bool use_timestamps = true;
};

/// Does a node take these numbers?
bool is_usable(const NodeConfig& config);

/// Counts of the exchange with a robot controller over RSI.
struct RsiCounters {
  bool is_in_use = false;
  std::uint64_t late_answers = 0;     ///< as the controller counts them
  std::uint32_t sessions = 0;         ///< runs of RSI on the controller that were seen
  std::uint32_t limited_answers = 0;  ///< held back by the limits of the answers
};

/// State of the bus and the streams, which messages do not show; set by who moves them.
struct LinkState {
  bool bus_fault = false;          ///< bus off, or frames not taken
  bool setpoint_conflict = false;  ///< SequenceMonitor::has_conflict of the stream
  bool wrench_conflict = false;
  StreamCounters setpoint;
  StreamCounters wrench;
  AuthenticationCounters authentication;
  RsiCounters rsi;
  std::uint32_t foreign_frames = 0;
  std::uint32_t dropped_frames = 0;  ///< own frames that could not be sent
  std::uint32_t stack_used = 0;      ///< bytes, the most there was; 0: not known
};

/// The compensator on a bus, whatever the bus: takes messages, ticks, and gives messages. Owns the
/// rules around the core: who may arm it and when, tables over the bus, faults that only show over
/// time, heartbeat, statistics. No allocation, no I/O; every call is bounded.
class Node {
 public:
  using Core = Compensator<float, 6>;

  /// Takes a configuration. Refused with not_ready while correcting, with bad_config if unusable
  /// or, once it has ticked, with another period, which is its caller's too; the one in use then
  /// stays. Keeps the table.
  Result configure(const NodeConfig& config);

  /// To be called once, before anything else.
  void use_memory(TableSlot first, TableSlot second) { store_.use_memory(first, second); }

  /// A table that has been opened, at start from slot 0 or 1 or TableStore::kFixed, or from a
  /// completed transfer: put to use between two ticks, or refused with a reason that `arm` repeats.
  Result start_with(std::size_t place, const Table& table, Result opened = Result::ok);
  Result conclude_transfer(Result opened, const Table& table);
  /// Goes without the table at start, or ends a completed transfer without its table, for a reason
  /// that is not the table's content.
  void refuse_start(Reply reason);
  void refuse_transfer(Reply reason);
  const void* received_table(std::size_t* size) const { return store_.received(size); }
  IndexMemory index_of_received() const { return store_.index_of_received(); }

  /// False if it is not used: a setpoint or wrench of another source than the one that sends them.
  bool receive(const Message& message, Source source, std::int64_t now);
  /// The same of the two that come every cycle.
  bool receive(const SetpointMessage& message, Source source, std::int64_t now);
  bool receive(const WrenchMessage& message, Source source, std::int64_t now);
  void set_link(const LinkState& link) { link_ = link; }
  /// To set it where it stands, without a copy.
  LinkState* link_state() { return &link_; }

  /// Angles of the newest setpoint, rad; null before the first.
  const JointAngles* setpoint() const { return has_setpoint_ ? &setpoint_.q : nullptr; }

  /// True once after a reset was asked for: who moves messages then forgets conflicts.
  bool take_reset() { return std::exchange(reset_requested_, false); }

  /// Asks for a fade to zero, as the command does.
  void disarm() { core_.disarm(); }
  bool is_at_zero() const { return core_.state() == State::off || core_.state() == State::latched; }

  /// One control period; `now` in ns of a monotonic clock.
  CorrectedMessage tick(std::int64_t now);

  /// The next message to send beside the corrected setpoint; false if there is none. At most eight
  /// replies to commands and eight to transfers wait at a time, and more are not given, so that
  /// heartbeats and faults have room however much is asked.
  bool next_message(Message* message);
  /// The same where it stands, until the node is asked for anything else; null if there is none.
  const Message* next_message();

  /// Tells the bus of an event: a code of node_status.hpp and what belongs to it.
  void announce(std::uint16_t code, std::uint32_t detail);

  /// Time from receiving a setpoint to sending its correction, ns.
  void record_latency(std::int64_t nanoseconds) { latency_.add(nanoseconds); }
  const LatencyHistogram& latency() const { return latency_; }

  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t late_ticks() const { return late_ticks_; }
  State state() const { return core_.state(); }
  std::size_t active_slot() const { return store_.active(); }
  const LinkState& link() const { return link_; }
  const WrenchMonitor& wrench_monitor() const { return wrench_monitor_; }

  /// Value of one statistic; `exists` is set to false for a name there is none for.
  std::uint64_t statistic(std::uint8_t name, bool* exists) const;

 private:
  void receive_one(const IdentityMessage& message);
  void receive_one(const CommandMessage& message);
  void receive_one(const TransferBeginMessage& message);
  void receive_one(const TransferDataMessage& message);
  void receive_one(const TransferEndMessage& message);
  void receive_one(const CorrectedMessage& message);
  template <typename Other>
  void receive_one(const Other& message);

  std::int64_t made_at(std::int64_t timestamp, TransportDelay* delay, std::int64_t now) const;
  std::uint8_t arm();
  Result put_to_use(const Table& table);
  void end_transfer(std::uint8_t result, std::size_t size);
  void reply(TransferStage stage, Reply result);
  template <typename SomeMessage>
  void post(const SomeMessage& message);
  template <typename SomeMessage>
  bool has_room() const;
  Core::Input input(std::int64_t now) const;
  std::uint16_t judge(std::int64_t now);
  void check_period(std::int64_t now);
  void announce_faults(std::uint32_t status, std::uint16_t node_status);
  void announce_refusals(std::int64_t now);
  void announce_changes(std::uint32_t bits, std::uint32_t* announced, std::uint16_t base,
                        std::uint32_t* inhibited);
  void announce_each(std::uint32_t bits, std::uint32_t changed, std::uint32_t* announced,
                     std::uint16_t base, std::uint32_t* inhibited);
  void beat(const Core::Output& output);

  NodeConfig config_;
  Core core_;
  Table table_;
  TableStore store_;
  std::uint8_t table_result_ = static_cast<std::uint8_t>(Result::no_table);
  double offered_gain_ = 0;  ///< largest safe gain of the last table that was offered

  SetpointMessage setpoint_;
  bool has_setpoint_ = false;
  bool setpoint_moved_ = false;
  std::int64_t setpoint_time_ = 0;  ///< ns, ours, when it was made as far as can be told
  WrenchMessage wrench_;
  bool has_wrench_ = false;
  std::int64_t wrench_time_ = 0;
  TransportDelay setpoint_delay_;
  TransportDelay wrench_delay_;
  WrenchMonitor wrench_monitor_;
  IdentityMessage identity_;
  bool has_identity_ = false;

  SourceMonitor setpoint_source_;
  SourceMonitor wrench_source_;
  LinkState link_;
  std::uint32_t losses_before_ = 0;
  bool reset_requested_ = false;
  std::uint16_t sticky_ = 0;  ///< faults that last until reset
  std::uint16_t node_latched_ = 0;

  std::int64_t last_tick_ = 0;
  std::int64_t started_at_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint64_t late_ticks_ = 0;
  std::uint64_t clock_jumps_ = 0;
  std::uint32_t late_excess_ = 0;  ///< late or early ticks beyond those on time, up to a fault
  std::uint64_t faults_ = 0;
  std::uint32_t ticks_to_heartbeat_ = 0;
  std::uint32_t announced_ = 0;
  std::uint32_t node_announced_ = 0;
  std::uint32_t inhibited_ = 0;  ///< bits whose change has been announced since the last heartbeat
  std::uint32_t node_inhibited_ = 0;
  RefusalWatch refusal_watch_;
  std::uint32_t refusals_announced_ = 0;
  std::uint32_t refusals_inhibited_ = 0;
  int report_from_ = -1;  ///< next statistic to report, none if negative
  LatencyHistogram latency_;

  static constexpr std::size_t kQueue = 32;
  std::array<Message, kQueue> queue_{};
  std::size_t queue_begin_ = 0;
  std::size_t queue_size_ = 0;
};

}  // namespace flexcomp
