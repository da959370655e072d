#include "simulation/plant.hpp"

#include <algorithm>
#include <cmath>

#include "linux/clock.hpp"

namespace flexcomp::simulation {
namespace {

constexpr std::int64_t kPatience = 1'000'000'000;  // ns, for an answer in lock-step
constexpr int kMostSilent = 5;                     // answers in a row, in lock-step
constexpr std::uint64_t kIdentityTicks = 50;       // from one announcement to the next
constexpr double kReadyTime = 0.3;                 // s, of good inputs before arming
constexpr double kArmingTime = 5;                  // s, to become active
constexpr double kFadeTime = 0.5;                  // s

JointAngles to_angles(const JointVector<double, 6>& q) {
  JointAngles angles{};
  std::copy_n(q.data(), angles.size(), angles.begin());
  return angles;
}

}  // namespace

Plant::Plant(std::unique_ptr<RobotInCut> robot, Contour contour, const PlantOptions& options,
             PlantBus* bus)
    : contour_(std::move(contour)),
      robot_(std::move(robot)),
      options_(options),
      bus_(bus),
      random_(options.seed),
      follower_(options.period, options.hold_time, kFadeTime) {}

PlantRun Plant::run(const std::function<void(double)>& progress) {
  next_ = monotonic_now();
  stand_still(kReadyTime);
  run_.armed = options_.compensate && arm();
  if (options_.compensate && !run_.armed) {
    return run_;
  }
  const double allowed = run_.largest_gain > 0 ? run_.largest_gain : 1;
  run_.gain = run_.armed ? std::min(options_.gain, allowed) : 0;
  run_.is_unstable = run_.gain > options_.stable_gain;
  if (run_.is_unstable) {
    bus_->send(CommandMessage{Command::disarm});
    stand_still(kReadyTime);
    return run_;
  }
  const auto loading = static_cast<int>(options_.load_time / options_.period);
  for (int i = 1; i <= loading; ++i) {
    tick(0, static_cast<double>(i) / loading);
  }
  const auto settling = static_cast<int>(options_.settling_time / options_.period);
  for (int i = 0; i < settling; ++i) {
    tick(0, 1);
  }
  follow_contour(progress);
  if (run_.armed) {
    bus_->send(CommandMessage{Command::disarm});
  }
  for (int i = loading - 1; i >= 0; --i) {
    tick(contour_.duration(), static_cast<double>(i) / loading);
  }

  const auto rows = static_cast<Eigen::Index>(rows_.size());
  run_.recording.time = Eigen::Map<const Eigen::VectorXd>(time_.data(), rows);
  recording::Samples samples(rows, 21);
  for (Eigen::Index i = 0; i < rows; ++i) {
    samples.row(i) = rows_[static_cast<std::size_t>(i)].transpose();
  }
  run_.recording.q_cmd = samples.leftCols(6);
  run_.recording.q_meas = samples.middleCols(6, 6);
  run_.recording.wrench = samples.middleCols(12, 6);
  run_.recording.position = samples.rightCols(3);
  return run_;
}

void Plant::stand_still(double seconds) {
  for (int i = 0; i < static_cast<int>(seconds / options_.period); ++i) {
    tick(0, 0);
  }
}

/// Asks to be armed, again where a setpoint that came late has cost it the good inputs that it
/// takes, and waits until the correction is complete.
bool Plant::arm() {
  const auto patience = static_cast<int>(kArmingTime / options_.period);
  const auto pause = static_cast<int>(kReadyTime / options_.period);
  int next_request = 0;
  int end = patience;
  for (int i = 0; i < end; ++i) {
    if (i == next_request) {
      bus_->send(CommandMessage{Command::arm});
    }
    replied_ = false;
    tick(0, 0);
    if (replied_ && run_.arm_reply != 0) {
      if (!may_become_ready()) {
        return false;
      }
      next_request = i + pause;
    } else if (replied_) {
      end = i + patience;  // it fades in
    }
    if (run_.last_state == static_cast<std::uint8_t>(State::active)) {
      return true;
    }
  }
  return false;
}

bool Plant::may_become_ready() const {
  return run_.arm_reply == static_cast<std::uint8_t>(Result::not_ready) &&
         run_.last_state == static_cast<std::uint8_t>(State::off);
}

void Plant::follow_contour(const std::function<void(double)>& progress) {
  on_contour_ = true;
  run_.least_engagement = state_.engagement;
  run_.most_engagement = state_.engagement;
  const auto ticks = static_cast<int>(std::ceil(contour_.duration() / options_.period));
  for (int i = 0; i <= ticks; ++i) {
    tick(i * options_.period, 1);
    run_.least_engagement = std::min(run_.least_engagement, state_.engagement);
    run_.most_engagement = std::max(run_.most_engagement, state_.engagement);
    progress(static_cast<double>(i) / ticks);
  }
  on_contour_ = false;
}

void Plant::tick(double time, double load) {
  const Contour::Point point = contour_.at(time);
  state_ = robot_->stand(point.q + follower_.correction(), point, load);
  const Wrench<double> wrench = measured(state_.wrench);
  if (run_.ticks % kIdentityTicks == 0) {
    bus_->send(IdentityMessage{options_.model_hash, WrenchFrame::base});
  }
  ++run_.ticks;
  const std::int64_t now = monotonic_now();
  if (on_contour_) {
    record(time, point, wrench);
    bus_->send(MeasuredJointsMessage{to_angles(point.q + follower_.correction())});
    bus_->send(
        MeasuredPositionMessage{{state_.position.x(), state_.position.y(), state_.position.z()}});
  }
  WrenchMessage message{now, {}, false};
  std::copy_n(wrench.data(), 6, message.wrench.begin());
  bus_->send(message);
  bus_->send(SetpointMessage{now, to_angles(point.q)});
  exchange();
}

/// Takes answers: until the corrected setpoint is there in lock-step, until the period is over in
/// real time.
void Plant::exchange() {
  const std::uint64_t corrected_before = corrected_;
  next_ += static_cast<std::int64_t>(1e9 * options_.period);
  const std::int64_t until = options_.lockstep ? monotonic_now() + kPatience : next_;
  Message message;
  while (true) {
    const bool answered = corrected_ != corrected_before;
    const std::int64_t left = until - monotonic_now();
    if (options_.lockstep && answered) {
      // Whatever came with it is there already.
      while (bus_->receive(&message, 0)) {
        take(message);
      }
      break;
    }
    if (left <= 0) {
      break;
    }
    if (bus_->receive(&message, left)) {
      take(message);
    } else if (options_.lockstep) {
      break;
    }
  }
  const bool is_answered = corrected_ != corrected_before;
  run_.unanswered += is_answered ? 0U : 1U;
  silent_ = is_answered ? 0 : silent_ + 1;
  if (options_.lockstep && silent_ >= kMostSilent) {
    throw NobodyAnswers();
  }
  follower_.end_period();
}

void Plant::take(const Message& message) {
  if (const auto* corrected = std::get_if<CorrectedMessage>(&message)) {
    ++corrected_;
    run_.last_state = corrected->state;
    if (on_contour_) {
      run_.was_lost = run_.was_lost ||
                      (run_.armed && corrected->state != static_cast<std::uint8_t>(State::active));
      run_.status |= corrected->status;
      run_.node_status |= corrected->node_status;
    }
    if (options_.compensate) {
      using Angles = Eigen::Map<const JointVector<double, 6>>;
      const auto state = static_cast<State>(corrected->state);
      follower_.take(Angles(corrected->corrected.data()) - Angles(corrected->uncorrected.data()),
                     !options_.obeys && (state == State::off || state == State::latched));
    }
  } else if (const auto* heartbeat = std::get_if<HeartbeatMessage>(&message)) {
    run_.latched = heartbeat->latched_faults;
    run_.node_latched = heartbeat->node_latched_faults;
  } else if (const auto* reply = std::get_if<CommandReplyMessage>(&message)) {
    if (reply->command == Command::arm) {
      replied_ = true;
      run_.arm_reply = reply->reply;
      run_.largest_gain = reply->largest_gain;
    }
  }
}

Wrench<double> Plant::measured(const Wrench<double>& wrench) {
  std::normal_distribution<double> normal(0, 1);
  Wrench<double> noisy = wrench;
  for (Eigen::Index i = 0; i < 6; ++i) {
    noisy[i] += (i < 3 ? options_.force_noise : options_.moment_noise) * normal(random_);
  }
  return noisy;
}

void Plant::record(double time, const Contour::Point& point, const Wrench<double>& wrench) {
  Eigen::Matrix<double, 21, 1> row;
  row << point.q, point.q + follower_.correction(), wrench, state_.position;
  time_.push_back(time);
  rows_.push_back(row);
}

}  // namespace flexcomp::simulation
