#pragma once

#include "linux/can_sender.hpp"
#include "linux/can_socket.hpp"
#include "linux/exchange.hpp"
#include "linux/options.hpp"
#include "linux/rdt_transport.hpp"
#include "linux/rsi_transport.hpp"
#include "messages/message_authentication.hpp"
#include "node/can_link.hpp"
#include "node/lcm_receiver.hpp"
#include "node/table_trial.hpp"

namespace flexcomp {

/// The real-time thread: waits for frames, telegrams, messages and the end of the period, and ticks
/// the node. Allocates nothing and takes no lock; the CAN socket is read and written here without
/// blocking, because handing frames to another thread costs more than the calls do. So is RSI's
/// socket.
///
/// There is exactly one tick a period, so the correction's limits hold in time as well as from tick
/// to tick. With Trigger::setpoint a setpoint is answered at once, and the periods are shifted, by
/// at most one percent each, so that setpoints come in their middle. A second one in the same
/// period is answered with the next; on RSI, where each telegram must be answered, with the
/// correction of the last tick.
class RealTimeLoop {
 public:
  /// `authentication`: of the messages on CAN, or null for none; `rsi`: a controller on RSI, or
  /// null for none; `sensor`: a force sensor on the network, or null for none. Throws
  /// std::runtime_error if the system refuses what it needs.
  RealTimeLoop(const Options& options, Node* node, CanSocket* can,
               MessageAuthentication* authentication, RsiTransport* rsi, RdtTransport* sensor,
               Exchange* exchange);

  /// Runs until told to stop and the correction is zero.
  void run();

 private:
  /// Work that waits.
  struct Ready {
    bool messages = false;
    bool frames = false;
    bool telegrams = false;
    bool timer = false;
  };

  Ready wait();
  void take_messages(std::int64_t now);
  void take(LcmSample* sample, std::int64_t now);
  void take_frames(std::int64_t now);
  void take(const CanFrame& frame, std::int64_t now);
  void take_telegrams(std::int64_t now);
  void note_link_state();
  void note_answer();
  void tell_latched(const Message& message);
  void on_setpoint(std::int64_t now);
  void on_timer(std::int64_t now);
  void on_period_end(std::int64_t now);
  void follow_setpoints(std::int64_t now);
  void tick(std::int64_t now);
  void hand_over_tables(std::int64_t now);
  void take(const Verdict& verdict);
  void send(const Message& message);
  void set_timer();
  Snapshot snapshot() const;
  std::int64_t node_time(std::int64_t now) const;

  Trigger trigger_;
  std::int64_t period_;  ///< ns
  Node* node_;
  CanSocket* can_;
  MessageAuthentication* authentication_;
  RsiTransport* rsi_;
  RdtTransport* sensor_;
  CanLink link_;
  CanSender sender_;
  bool use_lcm_;
  LcmReceiver lcm_;
  Exchange* exchange_;
  FileDescriptor epoll_;
  FileDescriptor timer_;

  std::int64_t period_end_ = 0;
  std::int64_t timer_at_ = 0;
  bool ticked_ = false;  ///< in this period
  std::int64_t setpoint_at_ = 0;
  bool answers_setpoint_ = false;
  std::int64_t steps_ = 0;      ///< ticks of Trigger::lockstep
  std::uint32_t transfer_ = 0;  ///< the one that waits for a verdict, or did so last
  bool awaits_verdict_ = false;
  std::uint32_t in_use_ = 0;  ///< the transfer that the table in use came with; 0 at start
  TableTrial trial_;
  bool trial_told_ = false;
  FaultsLatched latched_told_;  ///< what the other thread knows of
  std::int64_t verdict_due_ = 0;
  std::uint32_t lcm_dropped_ = 0;
  bool stopping_ = false;
  std::int64_t stopping_since_ = 0;
};

}  // namespace flexcomp
