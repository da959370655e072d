#include "linux/real_time_loop.hpp"

#include <sys/epoll.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "linux/clock.hpp"

namespace flexcomp {
namespace {

constexpr int kFramesAtOnce = 128;
constexpr int kTelegramsAtOnce = 16;
constexpr int kMessagesATick = 4;                         // beside the corrected setpoint
constexpr std::int64_t kLargestShift = 100;               // of the period, its divisor
constexpr std::int64_t kVerdictPatience = 2'000'000'000;  // ns; a check takes milliseconds
constexpr std::int64_t kLockstepPatience = 500'000'000;   // ns, for setpoints to fade out on

constexpr std::array<CanSocket::Filter, 2> kFilters = {{
    {0x100, 0x7C0},  // what is sent to the node
    {0x200, 0x7E0},  // what only the node sends
}};

void watch(int epoll, int number) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = number;
  if (epoll_ctl(epoll, EPOLL_CTL_ADD, number, &event) < 0) {
    throw std::runtime_error(std::string("cannot wait for input: ") + std::strerror(errno));
  }
}

}  // namespace

RealTimeLoop::RealTimeLoop(const Options& options, Node* node, CanSocket* can,
                           MessageAuthentication* authentication, RsiTransport* rsi,
                           RdtTransport* sensor, Exchange* exchange)
    : trigger_(options.settings.trigger),
      period_(std::llround(1e9 * static_cast<double>(options.settings.node.compensator.period))),
      node_(node),
      can_(can),
      authentication_(authentication),
      rsi_(rsi),
      sensor_(sensor),
      link_(options.fd, options.settings.tolerated_losses),
      sender_(can),
      use_lcm_(!options.lcm.empty()),
      lcm_(options.settings.tolerated_losses),
      exchange_(exchange),
      epoll_(epoll_create1(EPOLL_CLOEXEC)),
      timer_(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  watch(epoll_.number(), exchange_->to_real_time.number());
  watch(epoll_.number(), exchange_->lcm_received.number());
  watch(epoll_.number(), timer_.number());
  if (can_->is_open()) {
    can_->receive_only(kFilters.data(), kFilters.size());
    watch(epoll_.number(), can_->number());
  }
  if (rsi_ != nullptr) {
    watch(epoll_.number(), rsi_->number());
  }
}

void RealTimeLoop::run() {
  period_end_ = monotonic_now() + period_;
  set_timer();
  while (true) {
    const Ready ready = wait();
    const std::int64_t now = monotonic_now();
    if (ready.messages) {
      take_messages(now);
    }
    if (ready.frames) {
      take_frames(now);
    }
    if (ready.telegrams) {
      take_telegrams(now);
    }
    if (ready.timer) {
      on_timer(now);
    }
    const bool given_up =
        trigger_ == Trigger::lockstep && now - stopping_since_ > kLockstepPatience;
    if (stopping_ && (node_->is_at_zero() || given_up)) {
      break;
    }
  }
  exchange_->from_real_time.send(snapshot());
  exchange_->end();
}

RealTimeLoop::Ready RealTimeLoop::wait() {
  std::array<epoll_event, 6> events{};
  const int count = epoll_wait(epoll_.number(), events.data(), static_cast<int>(events.size()), -1);
  Ready ready;
  for (int i = 0; i < count; ++i) {
    const int number = events[static_cast<std::size_t>(i)].data.fd;
    ready.messages |=
        number == exchange_->to_real_time.number() || number == exchange_->lcm_received.number();
    ready.frames |= number == can_->number();
    ready.telegrams |= rsi_ != nullptr && number == rsi_->number();
    ready.timer |= number == timer_.number();
  }
  return ready;
}

void RealTimeLoop::set_timer() {
  timer_at_ = period_end_;
  itimerspec time{};
  time.it_value.tv_sec = period_end_ / 1'000'000'000;
  time.it_value.tv_nsec = period_end_ % 1'000'000'000;
  timerfd_settime(timer_.number(), TFD_TIMER_ABSTIME, &time, nullptr);
}

/// Lock-step counts its own time, so that a run is the same however fast it goes.
std::int64_t RealTimeLoop::node_time(std::int64_t now) const {
  return trigger_ == Trigger::lockstep ? steps_ * period_ : now;
}

void RealTimeLoop::take_messages(std::int64_t now) {
  exchange_->lcm_received.clear();
  LcmSample sample;
  while (exchange_->lcm_received.receive(&sample)) {
    take(&sample, now);
  }
  exchange_->to_real_time.clear();
  ToRealTime item;
  while (exchange_->to_real_time.receive(&item)) {
    if (const auto* config = std::get_if<NodeConfig>(&item)) {
      const Result result = node_->configure(*config);
      node_->announce(result == Result::ok ? kConfigInUseCode : kConfigRefusedCode,
                      static_cast<std::uint32_t>(result));
      exchange_->from_real_time.send(ConfigResult{result});
    } else if (const auto* verdict = std::get_if<Verdict>(&item)) {
      take(*verdict);
    } else if (std::holds_alternative<SnapshotRequest>(item)) {
      exchange_->from_real_time.send(snapshot());
    }
  }
  if (exchange_->is_to_stop() && !stopping_) {
    stopping_ = true;
    stopping_since_ = now;
    node_->disarm();
  }
}

void RealTimeLoop::take(const Verdict& verdict) {
  if (!awaits_verdict_ || verdict.transfer != transfer_) {
    return;  // it comes too late: the transfer was given up
  }
  awaits_verdict_ = false;
  if (verdict.refused != Reply::ok) {
    node_->refuse_transfer(verdict.refused);
  } else if (node_->conclude_transfer(verdict.opened, verdict.table) == Result::ok) {
    in_use_ = transfer_;
    trial_.begin();
    trial_told_ = false;
    exchange_->from_real_time.send(TableInUse{in_use_});
  }
}

/// A complete transfer is handed over for the check, again each tick until there is room, and given
/// up if no verdict comes: no later one would be taken else.
void RealTimeLoop::hand_over_tables(std::int64_t now) {
  std::size_t size = 0;
  const void* received = node_->received_table(&size);
  if (received == nullptr) {
    return;
  }
  if (!awaits_verdict_) {
    awaits_verdict_ = exchange_->from_real_time.send(
        TableReceived{transfer_ + 1, received, size, node_->index_of_received()});
    transfer_ += awaits_verdict_ ? 1U : 0U;
    verdict_due_ = now + kVerdictPatience;
  } else if (now > verdict_due_) {
    awaits_verdict_ = false;
    node_->refuse_transfer(Reply::transfer_not_checked);
  }
}

void RealTimeLoop::take(LcmSample* sample, std::int64_t now) {
  if (lcm_.receive(sample->message, sample->sequence, node_, node_time(now))) {
    on_setpoint(now);
  }
}

void RealTimeLoop::take_frames(std::int64_t now) {
  for (int i = 0; i < kFramesAtOnce; ++i) {
    CanFrame frame;
    const CanSocket::Received received = can_->receive(&frame);
    if (received == CanSocket::Received::nothing) {
      return;
    }
    if (received != CanSocket::Received::frame) {
      sender_.observe(received);
      continue;
    }
    if (authentication_ == nullptr) {
      take(frame, now);
      continue;
    }
    const FrameList& admitted = authentication_->admit(frame);
    for (std::size_t k = 0; k < admitted.count; ++k) {
      take(admitted.frames[k], now);
    }
  }
}

void RealTimeLoop::take(const CanFrame& frame, std::int64_t now) {
  if (link_.receive(frame, node_, node_time(now))) {
    on_setpoint(now);
  }
}

/// Each is answered at once, with the correction of the tick that it makes, or of the last one.
void RealTimeLoop::take_telegrams(std::int64_t now) {
  for (int i = 0; i < kTelegramsAtOnce; ++i) {
    const RsiTransport::Received received = rsi_->receive(node_, node_time(now));
    if (received == RsiTransport::Received::nothing) {
      return;
    }
    if (received == RsiTransport::Received::setpoint) {
      on_setpoint(now);
      rsi_->answer();
      note_answer();
    }
  }
}

void RealTimeLoop::on_setpoint(std::int64_t now) {
  setpoint_at_ = now;
  answers_setpoint_ = true;
  if (trigger_ == Trigger::lockstep) {
    ++steps_;
    tick(node_time(now));
  } else if (trigger_ == Trigger::setpoint && !ticked_ && now < period_end_) {
    ticked_ = true;
    tick(now);
    follow_setpoints(now);
  }
}

void RealTimeLoop::follow_setpoints(std::int64_t now) {
  const std::int64_t off_middle = period_end_ - now - period_ / 2;
  if (node_->is_at_zero()) {
    period_end_ -= off_middle;
  } else {
    const std::int64_t most = period_ / kLargestShift;
    period_end_ -= std::clamp(off_middle / 8, -most, most);
  }
  // Setting the timer costs a system call: only where it would come late by more than a shift.
  // Where it comes early it is set anew then.
  if (period_end_ < timer_at_ - period_ / kLargestShift) {
    set_timer();
  }
}

void RealTimeLoop::on_timer(std::int64_t now) {
  if (now >= period_end_) {
    on_period_end(now);
  } else {
    set_timer();
  }
}

void RealTimeLoop::on_period_end(std::int64_t now) {
  if (trigger_ == Trigger::clock || (trigger_ == Trigger::setpoint && !ticked_)) {
    tick(now);
  }
  ticked_ = false;
  const std::int64_t missed = (now - period_end_) / period_;
  period_end_ += (missed + 1) * period_;
  set_timer();
}

/// Tells the node how the links are.
void RealTimeLoop::note_link_state() {
  if (node_->take_reset()) {
    link_.forget_conflicts();
    lcm_.forget_conflicts();
    if (rsi_ != nullptr) {
      rsi_->forget_conflicts();
    }
    if (sensor_ != nullptr) {
      sensor_->forget_conflicts();
    }
  }
  LinkState state = link_.state();
  lcm_.add_to(&state);
  if (authentication_ != nullptr) {
    state.authentication = authentication_->counters();
  }
  state.bus_fault = sender_.has_fault();
  state.dropped_frames = sender_.dropped() + lcm_dropped_;
  if (rsi_ != nullptr) {
    rsi_->add_to(&state);
  }
  if (sensor_ != nullptr) {
    sensor_->add_to(&state);
  }
  node_->set_link(state);
}

void RealTimeLoop::tick(std::int64_t now) {
  if (sensor_ != nullptr) {
    sensor_->update(node_, now);
  }
  note_link_state();
  sender_.tick();

  const CorrectedMessage corrected = node_->tick(now);
  if (rsi_ != nullptr) {
    rsi_->observe(corrected);
  }
  send(corrected);
  trial_.observe(corrected);
  if (trial_.has_run() && !trial_told_) {
    trial_told_ = exchange_->from_real_time.send(TableHasRun{in_use_});
  }
  note_answer();
  Message message;
  for (int i = 0; i < kMessagesATick && node_->next_message(&message); ++i) {
    tell_latched(message);
    send(message);
  }
  hand_over_tables(monotonic_now());
}

/// Heartbeats say what is latched: handed over once, again each heartbeat until there is room.
void RealTimeLoop::tell_latched(const Message& message) {
  const auto* heartbeat = std::get_if<HeartbeatMessage>(&message);
  if (heartbeat == nullptr) {
    return;
  }
  const FaultsLatched now{heartbeat->latched_faults, heartbeat->node_latched_faults};
  const bool is_told =
      now.faults == latched_told_.faults && now.node_faults == latched_told_.node_faults;
  if (!is_told && exchange_->from_real_time.send(now)) {
    latched_told_ = now;
  }
}

/// The last setpoint has been answered, if it was not before.
void RealTimeLoop::note_answer() {
  if (answers_setpoint_) {
    answers_setpoint_ = false;
    node_->record_latency(monotonic_now() - setpoint_at_);
  }
}

void RealTimeLoop::send(const Message& message) {
  if (can_->is_open()) {
    const FrameList& frames = link_.encode(message);
    if (authentication_ != nullptr) {
      const SealedFrames& sealed = authentication_->seal(frames);
      sender_.send(sealed.frames.data(), sealed.count);
    } else {
      sender_.send(frames.frames.data(), frames.count);
    }
  }
  if (use_lcm_ && !exchange_->lcm_to_send.send(message)) {
    ++lcm_dropped_;
  }
}

Snapshot RealTimeLoop::snapshot() const {
  Snapshot all;
  for (std::size_t name = 0; name < all.value.size(); ++name) {
    all.value[name] = node_->statistic(static_cast<std::uint8_t>(name), &all.exists[name]);
  }
  return all;
}

}  // namespace flexcomp
