#include "flexcomp/compensator.hpp"

#include <cmath>

#include "checked_number.hpp"
#include "instantiate.hpp"
#include "packed_six.hpp"

#ifdef __FAST_MATH__
#error "flexcomp checks its inputs for NaN and infinity, which -ffast-math assumes away"
#endif

// All of a tick that stands in this file, as one function: what its parts hand each other stays in
// registers. That costs half a kilobyte, which a microcontroller does without.
#ifdef FLEXCOMP_VECTOR_REGISTERS
#define FLEXCOMP_AS_ONE [[gnu::flatten]]
#else
#define FLEXCOMP_AS_ONE
#endif

namespace flexcomp {
namespace {

template <typename Scalar>
bool is_fresh(Scalar age, Scalar limit) {
  return age >= Scalar(0) && age <= limit;
}

std::uint32_t bit_if(bool condition, StatusBit bit) {
  return condition ? static_cast<std::uint32_t>(bit) : 0U;
}

/// Periods in a time, rounded up.
template <typename Scalar>
std::uint32_t periods(Scalar time, Scalar period) {
  return static_cast<std::uint32_t>(std::ceil(time / period));
}

}  // namespace

template <typename Scalar, int Joints>
Result Compensator<Scalar, Joints>::configure(const Config& config) {
  constexpr Scalar kTwoPi = Scalar(6.283185307179586);
  if (unusable_member(config) != nullptr) {
    return Result::bad_config;
  }
  *this = Compensator();
  config_ = config;
  hold_ticks_ = periods(config.hold_time, config.period);
  const std::uint32_t fade_ticks = periods(config.fade_time, config.period);
  fade_step_ = Scalar(1) / static_cast<Scalar>(fade_ticks > 0 ? fade_ticks : 1);
  filter_share_ = config.filter_cutoff > Scalar(0)
                      ? -std::expm1(-kTwoPi * config.filter_cutoff * config.period)
                      : Scalar(1);
  return guards_.configure(config.limits, config.period);
}

template <typename Scalar, int Joints>
Result Compensator<Scalar, Joints>::set_table(const Table& table) {
  if (!table.is_open()) {
    return Result::no_table;
  }
  if (table.model_hash() != config_.model_hash) {
    return Result::table_other_model;
  }
  const auto largest_gain = static_cast<Scalar>(table.header().largest_gain);
  if (largest_gain > Scalar(0) && config_.gain > largest_gain) {
    return Result::gain_too_high;
  }
  table_ = table;
  cursor_ = TableCursor{};
  locate<Scalar, Joints>(table_, setpoint_, &cursor_);
  return Result::ok;
}

template <typename Scalar, int Joints>
Result Compensator<Scalar, Joints>::arm() {
  if (!table_.is_open()) {
    return Result::no_table;
  }
  if (state_ != State::off || good_ticks_ < config_.ready_ticks) {
    return Result::not_ready;
  }
  if (track<Scalar, Joints>(table_, setpoint_, &cursor_) > Scalar(0)) {
    locate<Scalar, Joints>(table_, setpoint_, &cursor_);
  }
  fade_ = 0;
  bad_excess_ = 0;
  aim_.setZero();
  state_ = State::fading_in;
  return Result::ok;
}

template <typename Scalar, int Joints>
void Compensator<Scalar, Joints>::disarm() {
  if (is_correcting() || state_ == State::holding) {
    state_ = State::fading_out;
  }
}

template <typename Scalar, int Joints>
Result Compensator<Scalar, Joints>::reset() {
  if (state_ != State::latched) {
    return Result::not_ready;
  }
  latched_faults_ = 0;
  state_ = State::off;
  return Result::ok;
}

template <typename Scalar, int Joints>
std::uint32_t Compensator<Scalar, Joints>::check_setpoint(const Input& input) const {
  using Six = PackedSix<Scalar>;
  std::uint32_t faults =
      bit_if(!is_fresh(input.setpoint_age, config_.setpoint_age_limit), kSetpointStale);
  Six q(input.setpoint);
  if (!q.is_finite()) {
    return faults | kSetpointNotFinite;
  }
  if (table_.is_open()) {
    const bool inside = q.is_within(Six::read(table_.header().joint_lower),
                                    Six::template read<1>(table_.header().joint_upper));
    faults |= bit_if(!inside, kSetpointOutOfRange);
  }
  if (has_setpoint_) {
    // The last setpoint may have been old when it was used: that much more time has passed.
    Six step = q - Six::template read<1>(setpoint_);
    Six reach = (config_.period + setpoint_age_) * Six::template read<0>(config_.joint_speed);
    faults |= bit_if(!step.is_within(-reach, reach), kSetpointJump);
  }
  return faults;
}

template <typename Scalar, int Joints>
std::uint32_t Compensator<Scalar, Joints>::check_wrench(const Input& input) const {
  using Six = PackedSix<Scalar>;
  std::uint32_t faults =
      bit_if(!is_fresh(input.wrench_age, config_.wrench_age_limit), kWrenchStale);
  if (!Six(input.wrench).is_finite()) {
    return faults | kWrenchNotFinite;
  }
  const Scalar force = input.wrench.template head<3>().squaredNorm();
  const Scalar moment = input.wrench.template tail<3>().squaredNorm();
  // Squares of huge numbers overflow to infinity, which is more than the square of any range.
  const bool inside = force <= config_.force_range * config_.force_range &&
                      moment <= config_.moment_range * config_.moment_range;
  return faults | bit_if(!inside, kWrenchOutOfRange);
}

template <typename Scalar, int Joints>
std::uint32_t Compensator<Scalar, Joints>::check(const Input& input) const {
  return check_setpoint(input) | check_wrench(input) | bit_if(input.external_fault, kExternalFault);
}

template <typename Scalar, int Joints>
void Compensator<Scalar, Joints>::take_setpoint(const Input& input, std::uint32_t faults) {
  const bool usable = (faults & (kSetpointNotFinite | kSetpointOutOfRange)) == 0;
  if (usable) {
    // Written as the look-up reads it, in vector registers: what was written number by number would
    // have to leave the processor's store buffer first.
    PackedSix<Scalar>(input.setpoint).store(&setpoint_);
    has_setpoint_ = true;
  }
  const bool known_age =
      usable && input.setpoint_age >= Scalar(0) && std::isfinite(input.setpoint_age);
  setpoint_age_ = known_age ? input.setpoint_age : setpoint_age_ + config_.period;
}

template <typename Scalar, int Joints>
void Compensator<Scalar, Joints>::filter(const Wrench<Scalar>& wrench) {
  using Six = PackedSix<Scalar>;
  if (has_wrench_) {
    Six last = Six::template read<0>(wrench_);
    (last + filter_share_ * (Six(wrench) - last)).store(&wrench_);
  } else {
    wrench_ = wrench;
    has_wrench_ = true;
  }
}

/// Looks up, deflects, inverts and limits: sets the full correction that would be right now.
template <typename Scalar, int Joints>
std::uint32_t Compensator<Scalar, Joints>::aim(Output* output) {
  using Six = PackedSix<Scalar>;
  Scalar outside = 0;
  const TableResponse<Scalar, Joints> response =
      look_up_response<Scalar, Joints>(table_, setpoint_, wrench_, &cursor_, &outside);
  if (!Six(response.deflection).is_finite() || !Six(response.correction).is_finite()) {
    return kNotComputable;
  }
  if (outside > config_.chart_margin) {
    return kOutsideChart;
  }
  std::uint32_t remarks = 0;
  Scalar scale = config_.gain;
  if (outside > Scalar(0)) {
    scale *= Scalar(1) - outside / config_.chart_margin;
    remarks |= kChartEdge;
  }
  const Scalar shift = scale * response.deflection.template head<3>().norm();
  if (shift > config_.deflection_limit) {
    scale *= config_.deflection_limit / shift;
    remarks |= kDeflectionLimited;
  }
  output->deflection = response.deflection;
  (scale * Six(response.correction)).store(&aim_);
  return remarks;
}

template <typename Scalar, int Joints>
void Compensator<Scalar, Joints>::change_state(std::uint32_t faults) {
  if (!is_correcting() && state_ != State::holding) {
    return;
  }
  if (faults == 0) {
    bad_excess_ -= bad_excess_ > 0 ? 1U : 0U;
    if (state_ == State::holding) {
      state_ = fade_ < Scalar(1) ? State::fading_in : State::active;
    }
    return;
  }
  state_ = State::holding;
  if (++bad_excess_ > hold_ticks_) {
    state_ = State::fading_out;
    latched_faults_ = faults;
  }
}

template <typename Scalar, int Joints>
void Compensator<Scalar, Joints>::fade() {
  if (state_ == State::fading_in) {
    fade_ += fade_step_;
    if (fade_ >= Scalar(1)) {
      fade_ = 1;
      state_ = State::active;
    }
  } else if (state_ == State::fading_out) {
    fade_ = fade_ > fade_step_ ? fade_ - fade_step_ : Scalar(0);
  }
}

/// Moves every joint's correction towards its faded aim.
template <typename Scalar, int Joints>
std::uint32_t Compensator<Scalar, Joints>::move(Output* output) {
  using Six = PackedSix<Scalar>;
  const bool correcting = state_ != State::off && state_ != State::latched;
  Six aim = correcting ? fade_ * Six(aim_) : Six();
  Angles targets;
  aim.store(&targets);
  output->correction = guards_.advance(targets);
  if (state_ == State::fading_out && fade_ == Scalar(0) && guards_.is_at_rest_at_zero()) {
    state_ = latched_faults_ != 0 ? State::latched : State::off;
  }
  return bit_if(guards_.limited_by_value(), kValueLimited) |
         bit_if(guards_.limited_by_rate(), kRateLimited);
}

template <typename Scalar, int Joints>
FLEXCOMP_AS_ONE auto Compensator<Scalar, Joints>::tick(const Input& input) -> Output {
  using Six = PackedSix<Scalar>;
  Output output;  // not zeroed: every field is set below, and that is a twelfth of the time
  output.deflection.setZero();
  std::uint32_t status = check(input);
  take_setpoint(input, status);
  if ((status & (kWrenchNotFinite | kWrenchOutOfRange)) == 0) {
    filter(input.wrench);
  }
  if ((status & kFaultBits) == 0) {
    if (is_correcting() || state_ == State::holding) {
      status |= aim(&output);
    } else if (state_ == State::off && table_.is_open()) {
      // Where it is on the program when it is armed, it is known where.
      track<Scalar, Joints>(table_, setpoint_, &cursor_);
    }
  }
  const std::uint32_t faults = status & kFaultBits;
  good_ticks_ =
      faults != 0 ? 0 : (good_ticks_ < config_.ready_ticks ? good_ticks_ + 1 : good_ticks_);
  change_state(faults);
  fade();
  status |= move(&output);
  (Six::template read<0>(setpoint_) + Six(output.correction)).store(&output.setpoint);
  output.status = status | bit_if(!has_setpoint_, kNoSetpoint);
  output.latched_faults = latched_faults_;
  output.state = state_;
  return output;
}

const char* describe(State state) {
  switch (state) {
    case State::off:
      return "off";
    case State::fading_in:
      return "fading in";
    case State::active:
      return "active";
    case State::holding:
      return "holding";
    case State::fading_out:
      return "fading out";
    case State::latched:
      return "latched";
  }
  return "unknown state";
}

const char* describe(StatusBit bit) {
  switch (bit) {
    case kSetpointNotFinite:
      return "setpoint not finite";
    case kSetpointStale:
      return "setpoint stale";
    case kSetpointOutOfRange:
      return "setpoint outside the joint limits";
    case kSetpointJump:
      return "setpoint jumps";
    case kWrenchNotFinite:
      return "wrench not finite";
    case kWrenchStale:
      return "wrench stale";
    case kWrenchOutOfRange:
      return "wrench beyond the sensor's range";
    case kOutsideChart:
      return "outside the table";
    case kExternalFault:
      return "fault reported by the caller";
    case kNotComputable:
      return "correction not computable";
    case kValueLimited:
      return "limited in value";
    case kRateLimited:
      return "limited in rate or acceleration";
    case kDeflectionLimited:
      return "limited at the TCP";
    case kChartEdge:
      return "at the edge of the table";
    case kNoSetpoint:
      return "no setpoint yet";
  }
  return "unknown bit";
}

#define FLEXCOMP_COMPENSATOR(Scalar, Joints) template class Compensator<Scalar, Joints>;
FLEXCOMP_INSTANTIATE(FLEXCOMP_COMPENSATOR)

}  // namespace flexcomp
