#include "rsi/link.hpp"

#include <algorithm>
#include <cmath>

#include "messages/digest.hpp"
#include "node/can_link.hpp"

namespace flexcomp {
namespace {

// ns, where the node was not ready to be armed
constexpr std::int64_t kAskAgain = 50'000'000;
constexpr std::int64_t kGiveUp = 5'000'000'000;

bool is_finite(const AxisAngles& angles) {
  return std::all_of(angles.begin(), angles.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

RsiLink::Due RsiLink::receive(std::string_view datagram, RsiPeer peer, Node* node,
                              std::int64_t now) {
  RsiTelegram telegram;
  if (read_telegram(datagram, config_.schema, &telegram) != RsiReading::ok) {
    ++corrupt_;
    return Due::nothing;
  }
  switch (session_.judge(peer, telegram.ipoc, telegram.late.value_or(0), digest(datagram), now)) {
    case RsiSession::Verdict::refused:
      return Due::nothing;
    case RsiSession::Verdict::repeated:
      return Due::the_same;
    case RsiSession::Verdict::begun:
      begin_session(telegram, node);
      break;
    case RsiSession::Verdict::next:
      late_answers_ += session_.newly_late();
      take_back_late_answer();
      break;
  }
  telegram_ = telegram;
  needs_answer_ = true;
  const bool is_used = node->receive(
      SetpointMessage{kNoTime, config_.axes.to_joints(telegram.setpoint)}, Source::rsi, now);
  hand_over(telegram, node, now);
  return is_used ? Due::tick : Due::answer;
}

void RsiLink::begin_session(const RsiTelegram& telegram, Node* node) {
  node->disarm();
  waits_for_zero_ = !node->is_at_zero();
  total_ = telegram.applied.value_or(AxisAngles{});
  added_.fill(0);
  output_.reset();
  wants_to_arm_ = false;
}

void RsiLink::hand_over(const RsiTelegram& telegram, Node* node, std::int64_t now) {
  if (telegram.wrench) {
    ++wrenches_;
    node->receive(WrenchMessage{kNoTime, *telegram.wrench, false}, Source::rsi, now);
  }
  if (telegram.armed) {
    follow_output(*telegram.armed, node, now);
  }
}

void RsiLink::follow_output(bool armed, Node* node, std::int64_t now) {
  const bool rises = armed && output_ == false;
  const bool falls = !armed && output_ == true;
  output_ = armed;
  if (falls) {
    wants_to_arm_ = false;
    node->receive(CommandMessage{Command::disarm}, Source::rsi, now);
  }
  if (rises) {
    wants_to_arm_ = true;
    ask_again_at_ = now;
    give_up_at_ = now + kGiveUp;
    if (node->state() == State::latched) {
      node->receive(CommandMessage{Command::reset}, Source::rsi, now);
    }
  }
  if (wants_to_arm_ && now >= ask_again_at_) {
    ask_again_at_ = now + kAskAgain;
    node->receive(CommandMessage{Command::arm}, Source::rsi, now);
    wants_to_arm_ = node->state() == State::off && now < give_up_at_;
  }
}

/// In a cycle whose telegram did not come there was no answer to be late.
void RsiLink::take_back_late_answer() {
  if (config_.mode != RsiMode::relative || session_.newly_late() <= session_.missed()) {
    return;
  }
  for (std::size_t i = 0; i < total_.size(); ++i) {
    total_[i] -= added_[i];
  }
}

void RsiLink::observe(const CorrectedMessage& corrected) {
  state_ = corrected.state;
  const auto state = static_cast<State>(corrected.state);
  waits_for_zero_ = waits_for_zero_ && state != State::off && state != State::latched;
  JointAngles difference{};
  for (std::size_t i = 0; i < difference.size(); ++i) {
    difference[i] = corrected.corrected[i] - corrected.uncorrected[i];
  }
  const AxisAngles wanted = config_.axes.to_correction(difference);
  if (is_finite(wanted)) {  // else there is no setpoint, and the correction stays where it is
    wanted_ = wanted;
  }
}

/// The whole correction of an axis after the next answer.
double RsiLink::next_total(std::size_t axis, bool* is_limited) const {
  const double wanted = waits_for_zero_ ? 0 : wanted_[axis];
  const double held = std::clamp(wanted, -config_.largest, config_.largest);
  const double step = std::clamp(held - total_[axis], -config_.largest_step, config_.largest_step);
  const double next = total_[axis] + step;
  constexpr double kUnit = 1e-6;  // degrees, of what is written: what is added up is what was sent
  *is_limited = *is_limited || std::abs(next - wanted) > kUnit;
  return std::round(next / kUnit) * kUnit;
}

std::string_view RsiLink::answer() {
  needs_answer_ = false;
  bool is_limited = false;
  RsiAnswer answer;
  answer.type = config_.type;
  answer.correction_name = config_.correction_name;
  answer.state_name = config_.state_name;
  answer.state = state_;
  answer.ipoc = telegram_.ipoc;
  for (std::size_t i = 0; i < total_.size(); ++i) {
    const double next = next_total(i, &is_limited);
    added_[i] = next - total_[i];
    total_[i] = next;
    answer.correction[i] = config_.mode == RsiMode::absolute ? next : added_[i];
  }
  limited_answers_ += is_limited ? 1U : 0U;
  text_.write(answer);
  return text_.text();
}

void RsiLink::add_to(LinkState* state) const {
  StreamCounters counters = session_.counters;
  counters.corrupt = corrupt_;
  state->setpoint = state->setpoint + counters;
  state->wrench.received += wrenches_;
  state->setpoint_conflict |= session_.has_conflict();
  state->rsi = {true, late_answers_, session_.sessions(), limited_answers_};
}

}  // namespace flexcomp
