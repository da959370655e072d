#include "node/node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "node/node_settings.hpp"
#include "node/seconds.hpp"

namespace flexcomp {
namespace {

constexpr float kEarliestTick = 0.5F;  // of a period
constexpr float kLatestTick = 1.5F;    // of a period
constexpr std::uint8_t kStatisticNames = 64 + LatencyHistogram::kBins;

std::uint16_t bit_if(bool condition, NodeBit bit) {
  return condition ? static_cast<std::uint16_t>(bit) : std::uint16_t{0};
}

std::uint8_t number(Result result) { return static_cast<std::uint8_t>(result); }

std::uint8_t number(Reply reply) { return static_cast<std::uint8_t>(reply); }

/// Joint angles, or a wrench.
JointVector<float, 6> to_core(const std::array<double, 6>& numbers) {
  return Eigen::Map<const JointVector<double, 6>>(numbers.data()).cast<float>();
}

template <typename Angles>
JointAngles from_core(const Angles& angles) {
  return {angles[0], angles[1], angles[2], angles[3], angles[4], angles[5]};
}

/// `refused`: messages of another source than the one that has the stream.
std::uint64_t stream_statistic(const StreamCounters& counters, std::uint32_t refused,
                               unsigned which) {
  const std::array<std::uint32_t, 8> values = {counters.received - refused,
                                               counters.lost,
                                               counters.repeated,
                                               counters.old,
                                               counters.out_of_sequence,
                                               counters.contradicting + refused,
                                               counters.corrupt,
                                               counters.incomplete};
  return values[which];
}

std::uint32_t losses_in(const StreamCounters& stream) {
  return stream.lost + stream.corrupt + stream.incomplete;
}

/// Are all numbers in their range? A heartbeat's period is counted in ticks.
bool numbers_are_usable(const NodeConfig& config) {
  constexpr double kMostTicksToHeartbeat = 1e9;
  NodeSettings settings;
  settings.node = config;
  return numbers_are_in_range(settings) &&
         config.heartbeat_period / static_cast<double>(config.compensator.period) <=
             kMostTicksToHeartbeat;
}

}  // namespace

bool is_usable(const NodeConfig& config) {
  Node::Core core;
  return numbers_are_usable(config) && core.configure(config.compensator) == Result::ok;
}

Result Node::configure(const NodeConfig& config) {
  if (core_.state() != State::off && core_.state() != State::latched) {
    return Result::not_ready;
  }
  if (ticks_ > 0 && config.compensator.period != config_.compensator.period) {
    return Result::bad_config;
  }
  Core core;
  if (!numbers_are_usable(config) || core.configure(config.compensator) != Result::ok) {
    return Result::bad_config;
  }
  core_ = core;
  config_ = config;
  ticks_to_heartbeat_ = 0;
  wrench_monitor_.configure(config.wrench);
  if (table_.is_open()) {
    table_result_ = number(put_to_use(table_));
  }
  return Result::ok;
}

Result Node::put_to_use(const Table& table) {
  offered_gain_ = static_cast<double>(table.header().largest_gain);
  const Result result = core_.set_table(table);
  if (result == Result::ok) {
    table_ = table;
    sticky_ &= static_cast<std::uint16_t>(~kTableDamaged);
  }
  return result;
}

Result Node::start_with(std::size_t place, const Table& table, Result opened) {
  const Result result = opened == Result::ok ? put_to_use(table) : opened;
  table_result_ = number(result);
  if (result == Result::ok) {
    store_.use(place, &table.header(), table.size());
  } else {
    announce(kTableRefusedCode, number(result));
  }
  return result;
}

Result Node::conclude_transfer(Result opened, const Table& table) {
  const Result result = opened == Result::ok ? put_to_use(table) : opened;
  end_transfer(number(result), result == Result::ok ? table.size() : 0);
  return result;
}

void Node::refuse_start(Reply reason) {
  table_result_ = number(reason);
  announce(kTableRefusedCode, number(reason));
}

void Node::refuse_transfer(Reply reason) { end_transfer(number(reason), 0); }

void Node::end_transfer(std::uint8_t result, std::size_t size) {
  table_result_ = result;
  const bool in_use = result == number(Result::ok);
  store_.conclude(size);
  post(TransferReplyMessage{TransferStage::end, result, store_.words_received()});
  if (in_use) {
    announce(kTableInUseCode, static_cast<std::uint32_t>(store_.active() + 1));
  } else {
    announce(kTableRefusedCode, result);
  }
}

void Node::announce(std::uint16_t code, std::uint32_t detail) {
  post(FaultMessage{code, true, detail});
}

template <typename SomeMessage>
void Node::post(const SomeMessage& message) {
  if (!has_room<SomeMessage>()) {
    return;  // nobody takes them: the oldest are the ones that explain how it began
  }
  queue_[(queue_begin_ + queue_size_++) % kQueue] = message;
}

/// Few answers wait: else whoever asks much would crowd out what the node says by itself.
template <typename SomeMessage>
bool Node::has_room() const {
  constexpr std::size_t kMostAnswers = 8;  // of a kind
  constexpr bool kIsAnswer = std::is_same_v<SomeMessage, CommandReplyMessage> ||
                             std::is_same_v<SomeMessage, TransferReplyMessage>;
  if (queue_size_ == kQueue) {
    return false;
  }
  std::size_t alike = 0;
  for (std::size_t i = 0; kIsAnswer && i < queue_size_; ++i) {
    const Message& waiting = queue_[(queue_begin_ + i) % kQueue];
    alike += std::holds_alternative<SomeMessage>(waiting) ? 1U : 0U;
  }
  return alike < kMostAnswers;
}

bool Node::next_message(Message* message) {
  const Message* const next = next_message();
  if (next != nullptr) {
    *message = *next;
  }
  return next != nullptr;
}

const Message* Node::next_message() {
  if (queue_size_ == 0) {
    return nullptr;
  }
  const Message* const next = &queue_[queue_begin_];
  queue_begin_ = (queue_begin_ + 1) % kQueue;
  --queue_size_;
  return next;
}

bool Node::receive(const Message& message, Source source, std::int64_t now) {
  if (const auto* setpoint = std::get_if<SetpointMessage>(&message)) {
    return receive(*setpoint, source, now);
  }
  if (const auto* wrench = std::get_if<WrenchMessage>(&message)) {
    return receive(*wrench, source, now);
  }
  std::visit([&](const auto& content) { receive_one(content); }, message);
  return true;
}

bool Node::receive(const SetpointMessage& message, Source source, std::int64_t now) {
  if (!setpoint_source_.admit(source, now)) {
    return false;
  }
  setpoint_moved_ = !has_setpoint_ || message.q != setpoint_.q;
  setpoint_ = message;
  has_setpoint_ = true;
  setpoint_time_ = made_at(message.timestamp, &setpoint_delay_, now);
  return true;
}

bool Node::receive(const WrenchMessage& message, Source source, std::int64_t now) {
  if (!wrench_source_.admit(source, now)) {
    return false;
  }
  const std::int64_t made = made_at(message.timestamp, &wrench_delay_, now);
  if (wrench_monitor_.accept(message, now)) {
    wrench_ = message;
    has_wrench_ = true;
    wrench_time_ = made;
  }
  return true;
}

/// When a message received `now` was made, in our time.
std::int64_t Node::made_at(std::int64_t timestamp, TransportDelay* delay, std::int64_t now) const {
  return config_.use_timestamps ? now - delay->observe(timestamp, now) : now;
}

void Node::receive_one(const IdentityMessage& message) {
  identity_ = message;
  has_identity_ = true;
}

void Node::receive_one(const CommandMessage& message) {
  std::uint8_t answer = number(Result::bad_argument);
  switch (message.command) {
    case Command::arm:
      answer = arm();
      break;
    case Command::disarm:
      core_.disarm();
      answer = number(Result::ok);
      break;
    case Command::reset:
      reset_requested_ = true;
      link_.setpoint_conflict = false;
      link_.wrench_conflict = false;
      setpoint_source_.clear_conflict();
      wrench_source_.clear_conflict();
      sticky_ = 0;
      node_latched_ = 0;
      answer = number(core_.state() == State::latched ? core_.reset() : Result::ok);
      break;
    case Command::report:
      report_from_ = 0;
      answer = number(Result::ok);
      break;
    case Command::none:
      break;
  }
  post(CommandReplyMessage{message.command, answer, offered_gain_});
}

std::uint8_t Node::arm() {
  if (config_.require_identity) {
    if (!has_identity_) {
      return number(Reply::robot_unknown);
    }
    if (identity_.model_hash != config_.compensator.model_hash) {
      return number(Reply::other_robot);
    }
    if (identity_.wrench_frame != WrenchFrame::base) {
      return number(Reply::wrong_wrench_frame);
    }
  }
  if (sticky_ != 0) {
    return number(Reply::fault_present);
  }
  const Result result = core_.arm();
  const bool table_was_refused = table_result_ != number(Result::ok);
  return result == Result::no_table && table_was_refused ? table_result_ : number(result);
}

void Node::receive_one(const TransferBeginMessage& message) {
  reply(TransferStage::begin, store_.begin(message));
}

void Node::receive_one(const TransferDataMessage& message) {
  const Reply result = store_.add(message);
  if (result != Reply::ok) {
    reply(TransferStage::data, result);
  }
}

void Node::receive_one(const TransferEndMessage& message) {
  const Reply result = store_.end(message);
  if (result != Reply::ok) {
    reply(TransferStage::end, result);
  }
}

void Node::receive_one(const CorrectedMessage& /*message*/) { sticky_ |= kOtherNode; }

/// Ignores what others say to each other.
template <typename Other>
void Node::receive_one(const Other& /*message*/) {}

void Node::reply(TransferStage stage, Reply result) {
  post(TransferReplyMessage{stage, number(result), store_.words_received()});
}

void Node::check_period(std::int64_t now) {
  const float elapsed = seconds(now - last_tick_);
  const float period = config_.compensator.period;
  clock_jumps_ += elapsed <= 0 ? 1U : 0U;
  const bool on_time = elapsed >= kEarliestTick * period && elapsed <= kLatestTick * period;
  if (ticks_ > 0 && !on_time) {
    ++late_ticks_;
    late_excess_ = std::min(late_excess_ + 1, config_.late_ticks);
  } else {
    late_excess_ -= late_excess_ > 0 ? 1U : 0U;
  }
  last_tick_ = now;
}

/// Node status of this tick, but for what depends on the predicted deflection.
std::uint16_t Node::judge(std::int64_t now) {
  check_period(now);
  wrench_monitor_.observe_motion(setpoint_moved_, now);
  setpoint_moved_ = false;
  sticky_ |= bit_if(!store_.scrub(), kTableDamaged);
  sticky_ |= bit_if(link_.setpoint_conflict || setpoint_source_.has_conflict(), kSetpointConflict);
  sticky_ |= bit_if(link_.wrench_conflict || wrench_source_.has_conflict(), kWrenchConflict);
  const bool identity_fits = identity_.model_hash == config_.compensator.model_hash &&
                             identity_.wrench_frame == WrenchFrame::base;
  const std::uint32_t losses = losses_in(link_.setpoint) + losses_in(link_.wrench);
  const bool lost = losses != losses_before_;
  losses_before_ = losses;
  return static_cast<std::uint16_t>(
      sticky_ | bit_if(wrench_monitor_.is_stuck(), kWrenchStuck) |
      bit_if(config_.require_identity && has_identity_ && !identity_fits, kIdentityMismatch) |
      bit_if(late_excess_ >= config_.late_ticks, kTickLate) | bit_if(link_.bus_fault, kBusFault) |
      bit_if(wrench_monitor_.last_was_saturated(), kWrenchSaturated) |
      bit_if(wrench_monitor_.last_was_implausible(), kWrenchImplausible) | bit_if(lost, kSomeLost));
}

Node::Core::Input Node::input(std::int64_t now) const {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  Core::Input input;  // not zeroed: every field is set
  input.setpoint = to_core(setpoint_.q);
  input.setpoint_age = has_setpoint_ ? seconds(now - setpoint_time_) : kNever;
  input.wrench = to_core(wrench_.wrench);
  input.wrench_age = has_wrench_ ? seconds(now - wrench_time_) : kNever;
  if (!has_setpoint_) {
    input.setpoint.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  return input;
}

CorrectedMessage Node::tick(std::int64_t now) {
  if (ticks_ == 0) {
    started_at_ = now;
  }
  std::uint16_t node_status = judge(now);
  Core::Input in = input(now);
  in.external_fault = (node_status & kNodeFaultBits) != 0;
  const State before = core_.state();
  const Core::Output out = core_.tick(in);
  if (before == State::holding && out.state == State::fading_out) {
    node_latched_ |= node_status & kNodeFaultBits;
  }

  const auto deflection = static_cast<double>(out.deflection.head<3>().norm());
  node_status |= bit_if(deflection > config_.deflection_warning, kDeflectionWarning);
  if (deflection > config_.deflection_error) {
    sticky_ |= kDeflectionTooLarge;
  }
  node_status |= sticky_ & kDeflectionTooLarge;

  announce_faults(out.status & kFaultBits, node_status & kNodeFaultBits);
  announce_refusals(now);
  beat(out);
  ++ticks_;

  CorrectedMessage message{setpoint_.timestamp,
                           from_core(out.setpoint),
                           from_core(out.setpoint - out.correction),
                           out.status,
                           node_status,
                           static_cast<std::uint8_t>(out.state)};
  if ((out.status & kNoSetpoint) != 0) {
    message.corrected.fill(std::numeric_limits<double>::quiet_NaN());
    message.uncorrected.fill(std::numeric_limits<double>::quiet_NaN());
  }
  return message;
}

void Node::announce_faults(std::uint32_t status, std::uint16_t node_status) {
  announce_changes(status & ~std::uint32_t{kExternalFault}, &announced_, kCompensatorFaultCode,
                   &inhibited_);
  announce_changes(node_status, &node_announced_, kNodeFaultCode, &node_inhibited_);
}

void Node::announce_refusals(std::int64_t now) {
  announce_changes(refusal_watch_.observe(link_.authentication, now), &refusals_announced_,
                   kForgedCode, &refusals_inhibited_);
}

/// Posts what began or ended, a bit at most once between two heartbeats: a fault that flickers must
/// not fill the bus. What the queue has no room for is posted later.
[[gnu::always_inline]] inline void Node::announce_changes(std::uint32_t bits,
                                                          std::uint32_t* announced,
                                                          std::uint16_t base,
                                                          std::uint32_t* inhibited) {
  const std::uint32_t changed = (bits ^ *announced) & ~*inhibited;
  if (changed != 0) {
    announce_each(bits, changed, announced, base, inhibited);
  }
}

void Node::announce_each(std::uint32_t bits, std::uint32_t changed, std::uint32_t* announced,
                         std::uint16_t base, std::uint32_t* inhibited) {
  for (std::uint32_t left = changed & 0xFFFFU; left != 0 && queue_size_ < kQueue;
       left &= left - 1U) {
    const int place = __builtin_ctz(left);
    const std::uint32_t bit = 1U << place;
    const bool began = (bits & bit) != 0;
    post(FaultMessage{static_cast<std::uint16_t>(base + place), began, 0});
    faults_ += began ? 1U : 0U;
    *announced ^= bit;
    *inhibited |= bit;
  }
}

void Node::beat(const Core::Output& output) {
  if (report_from_ >= 0 && queue_size_ < kQueue / 2) {
    bool exists = false;
    while (!exists && report_from_ < kStatisticNames) {
      const auto name = static_cast<std::uint8_t>(report_from_++);
      const std::uint64_t value = statistic(name, &exists);
      if (exists) {
        post(StatisticMessage{name, value});
      }
    }
    report_from_ = report_from_ < kStatisticNames ? report_from_ : -1;
  }
  if (ticks_to_heartbeat_ > 0) {
    --ticks_to_heartbeat_;
    return;
  }
  if (queue_size_ == kQueue) {
    return;  // it comes when there is room
  }
  const auto period = static_cast<double>(config_.compensator.period);
  ticks_to_heartbeat_ = static_cast<std::uint32_t>(config_.heartbeat_period / period);
  inhibited_ = 0;
  node_inhibited_ = 0;
  refusals_inhibited_ = 0;
  HeartbeatMessage message;
  message.uptime = static_cast<std::uint32_t>((last_tick_ - started_at_) / 1'000'000'000);
  message.state = static_cast<std::uint8_t>(output.state);
  message.slot = store_.active() == TableStore::kNone
                     ? std::uint8_t{0}
                     : static_cast<std::uint8_t>(store_.active() + 1);
  message.table_result = table_result_;
  message.latched_faults = output.latched_faults;
  message.node_latched_faults = node_latched_;
  message.table_model_hash = table_.is_open() ? table_.model_hash() : 0;
  message.largest_gain = table_.is_open() ? static_cast<double>(table_.header().largest_gain) : 0.0;
  post(message);
}

std::uint64_t Node::statistic(std::uint8_t name, bool* exists) const {
  constexpr auto kSetpoint = static_cast<unsigned>(StatisticName::setpoint_received);
  constexpr auto kWrench = static_cast<unsigned>(StatisticName::wrench_received);
  constexpr auto kLatency = static_cast<unsigned>(StatisticName::latency);
  constexpr unsigned kStreamNames = 8;
  *exists = true;
  if (name >= kSetpoint && name < kSetpoint + kStreamNames) {
    return stream_statistic(link_.setpoint, setpoint_source_.refused(), name - kSetpoint);
  }
  if (name >= kWrench && name < kWrench + kStreamNames) {
    return stream_statistic(link_.wrench, wrench_source_.refused(), name - kWrench);
  }
  if (name >= kLatency && name < kLatency + LatencyHistogram::kBins) {
    return latency_.counts()[name - kLatency];
  }
  switch (static_cast<StatisticName>(name)) {
    case StatisticName::ticks:
      return ticks_;
    case StatisticName::late_ticks:
      return late_ticks_;
    case StatisticName::clock_jumps:
      return clock_jumps_;
    case StatisticName::faults:
      return faults_;
    case StatisticName::saturated_samples:
      return wrench_monitor_.saturated_samples();
    case StatisticName::implausible_samples:
      return wrench_monitor_.implausible_samples();
    case StatisticName::foreign_frames:
      return link_.foreign_frames;
    case StatisticName::dropped_frames:
      return link_.dropped_frames;
    case StatisticName::stack_used:
      return link_.stack_used;
    case StatisticName::forged_messages:
      *exists = link_.authentication.has_key;
      return link_.authentication.forged;
    case StatisticName::not_fresh_messages:
      *exists = link_.authentication.has_key;
      return link_.authentication.not_fresh;
    case StatisticName::unauthenticated_messages:
      *exists = link_.authentication.has_key;
      return link_.authentication.unauthenticated;
    case StatisticName::late_answers:
      *exists = link_.rsi.is_in_use;
      return link_.rsi.late_answers;
    case StatisticName::rsi_sessions:
      *exists = link_.rsi.is_in_use;
      return link_.rsi.sessions;
    case StatisticName::limited_answers:
      *exists = link_.rsi.is_in_use;
      return link_.rsi.limited_answers;
    default:
      *exists = false;
      return 0;
  }
}

}  // namespace flexcomp
