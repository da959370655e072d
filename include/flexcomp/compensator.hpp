#pragma once

/// @file
/// The tick: setpoint and wrench in, corrected setpoint and status out.

#include <array>
#include <cstdint>

#include "flexcomp/guard.hpp"
#include "flexcomp/table.hpp"

namespace flexcomp {

/// State of the compensator. The numbers are stable: they appear on the bus.
enum class State : std::uint8_t {
  off = 0,         ///< no correction
  fading_in = 1,   ///< armed; the correction grows to its full size
  active = 2,      ///< full correction
  holding = 3,     ///< an input is bad: the correction stays where it is for the hold time
  fading_out = 4,  ///< the correction shrinks to zero
  latched = 5,     ///< no correction after a fault, until `reset`
};

/// A few words for a person; never null.
const char* describe(State state);

/// Bits of the status word. The lower half are faults: each makes the compensator hold and, if it
/// lasts, fade out and latch. The upper half are remarks. The numbers are stable.
enum StatusBit : std::uint32_t {
  kSetpointNotFinite = 1U << 0,
  kSetpointStale = 1U << 1,       ///< age above the limit, negative or not finite
  kSetpointOutOfRange = 1U << 2,  ///< outside the joint limits in the table
  kSetpointJump = 1U << 3,        ///< faster than the joint can move
  kWrenchNotFinite = 1U << 4,
  kWrenchStale = 1U << 5,       ///< age above the limit, negative or not finite
  kWrenchOutOfRange = 1U << 6,  ///< beyond the sensor's range, which means it is saturated or wrong
  kOutsideChart = 1U << 7,      ///< further outside the table's chart than the margin
  kExternalFault = 1U << 8,     ///< reported by the caller
  kNotComputable = 1U << 9,     ///< the table gave a number that is not finite
  kValueLimited = 1U << 16,     ///< a joint's correction is at its largest value
  kRateLimited = 1U << 17,      ///< a joint's correction is on its way, as fast as allowed
  kDeflectionLimited = 1U << 18,  ///< scaled down to the largest correction at the TCP
  kChartEdge = 1U << 19,          ///< outside the chart but within the margin: scaled down
  kNoSetpoint = 1U << 20,         ///< there never was a usable setpoint: do not use the output
};

/// The bits that are faults.
constexpr std::uint32_t kFaultBits = 0xFFFFU;

/// A few words for a person on one status bit; never null.
const char* describe(StatusBit bit);

/// Numbers of a compensator; the robot controller's, the sensor's and the job's.
template <typename Scalar, int Joints>
struct CompensatorConfig {
  Scalar period = 0;              ///< s, from one tick to the next
  std::uint64_t model_hash = 0;   ///< of the robot that is there; a table of another is refused
  Scalar gain = 1;                ///< share of the deflection that is corrected, above 0 to 1
  Scalar filter_cutoff = 0;       ///< Hz, of the first-order low-pass on the wrench; 0: no filter
  Scalar force_range = 0;         ///< N, largest plausible magnitude
  Scalar moment_range = 0;        ///< N·m
  Scalar setpoint_age_limit = 0;  ///< s, beyond it a setpoint is stale
  Scalar wrench_age_limit = 0;    ///< s
  JointVector<Scalar, Joints> joint_speed =  ///< rad/s, largest plausible
      JointVector<Scalar, Joints>::Zero();
  std::array<CorrectionLimits<Scalar>, Joints> limits{};  ///< the correction's
  Scalar deflection_limit = 0;                            ///< m, largest correction at the TCP
  Scalar chart_margin = 0;  ///< rad, outside the chart, over which the correction fades
  Scalar hold_time =
      0;  ///< s, by which time with a fault may exceed time without before fading out
  Scalar fade_time = 0;  ///< s, from nothing to full correction and back; at most 1e6 periods
  std::uint32_t ready_ticks = 10;  ///< good inputs in a row before it may be armed
};

/// The first number that no compensator takes, by its member's name ("limits" for any joint's);
/// null where it takes all. Times and limits are counted in periods: where they would do with a
/// period of 1 ms and do not with one outside 0.1 ms to 1 s, it is "period".
template <typename Scalar, int Joints>
const char* unusable_member(const CompensatorConfig<Scalar, Joints>& config);

/// Input of one tick.
template <typename Scalar, int Joints>
struct CompensatorInput {
  JointVector<Scalar, Joints> setpoint;  ///< rad, uncorrected
  Scalar setpoint_age;                   ///< s, since it was made
  Wrench<Scalar> wrench;                 ///< on the tool at the TCP, base frame
  Scalar wrench_age;                     ///< s, since it was measured
  bool external_fault = false;           ///< anything the caller knows: bus off, late tick, …
};

/// Result of one tick.
template <typename Scalar, int Joints>
struct CompensatorOutput {
  JointVector<Scalar, Joints> setpoint;    ///< rad, corrected; always finite
  JointVector<Scalar, Joints> correction;  ///< rad, part of the above; within all limits
  Twist<Scalar> deflection;      ///< predicted for the filtered wrench, base frame; zero when off
  std::uint32_t status;          ///< bits of this tick
  std::uint32_t latched_faults;  ///< what led to the last fade-out, until `reset`
  State state;                   ///< after this tick
};

/// The tick: setpoint, wrench and their ages in; corrected setpoint and status out.
///
/// Each tick does, in this order: check the inputs; filter the wrench; look up the compliance (when
/// off: only follows the program);
/// compute the deflection; invert it to a joint correction; limit its size; fade; move there within
/// the rate and acceleration limits. Constant time, no memory but the object.
///
/// Never a jump: whatever comes in, the correction obeys value, rate and acceleration limits
/// (`Guard`), also through faults, arming, disarming and a change of table. A fault holds the
/// correction for `hold_time`; if it lasts longer the correction fades to zero and stays there
/// until `reset`. An unusable setpoint is replaced by the last usable one.
///
/// How long a fault lasts is counted, not timed, so that one that comes and goes cannot last for
/// ever: each tick with any fault counts one up, each good tick one down, not below zero, and
/// beyond `hold_time` in ticks the correction fades out. A single bad tick, or a burst shorter than
/// `hold_time` with as many good ones after it, leaves nothing behind. Where a share s of the
/// ticks, more than half, is bad, it fades out after hold_time / (2 s − 1).
///
/// Not a safety function: the robot controller's own limits and stops must hold without it.
template <typename Scalar, int Joints>
class Compensator {
  static_assert(Joints == static_cast<int>(kTableJoints), "it reads tables, which hold six joints");

 public:
  using Config = CompensatorConfig<Scalar, Joints>;  ///< given once
  using Input = CompensatorInput<Scalar, Joints>;    ///< one for each tick
  using Output = CompensatorOutput<Scalar, Joints>;  ///< one for each tick

  /// Takes a configuration and forgets all that was, the correction too: not while a robot moves by
  /// one. Returns ok, or bad_config (`unusable_member`) with nothing changed.
  Result configure(const Config& config);

  /// Gives it a table, which must outlive its use. Between ticks, in any state: the correction
  /// moves to the new table's within its limits. Cost: that of `locate`. Returns ok, or no_table,
  /// table_other_model or gain_too_high, with the table in use unchanged.
  Result set_table(const Table& table);

  /// Starts to correct. Cost: that of a look-up where the last ticks were on the program, else that
  /// of `locate`. Returns ok, or no_table, or not_ready: not off, or
  /// fewer than `ready_ticks` good inputs in a row.
  Result arm();

  /// Fades out, then off. Does nothing when off or latched.
  void disarm();

  /// From latched to off. Returns ok or not_ready.
  Result reset();

  /// One control period.
  Output tick(const Input& input);

  State state() const { return state_; }  ///< after the last call

  /// Has it a configuration? One whose `configure` failed, or that was never given one, has none,
  /// and corrects nothing.
  bool is_configured() const { return config_.period > Scalar(0); }

 private:
  using Angles = JointVector<Scalar, Joints>;

  std::uint32_t check(const Input& input) const;
  std::uint32_t check_setpoint(const Input& input) const;
  std::uint32_t check_wrench(const Input& input) const;
  void take_setpoint(const Input& input, std::uint32_t faults);
  void filter(const Wrench<Scalar>& wrench);
  std::uint32_t aim(Output* output);
  void change_state(std::uint32_t faults);
  void fade();
  std::uint32_t move(Output* output);
  bool is_correcting() const { return state_ == State::fading_in || state_ == State::active; }

  Config config_{};
  Scalar filter_share_ = 1;
  Scalar fade_step_ = 1;
  std::uint32_t hold_ticks_ = 0;

  Table table_;
  TableCursor cursor_;
  State state_ = State::off;
  std::uint32_t latched_faults_ = 0;
  std::uint32_t good_ticks_ = 0;
  std::uint32_t bad_excess_ = 0;  ///< ticks with a fault beyond those without, since it was armed
  Angles setpoint_ = Angles::Zero();  ///< last usable
  Scalar setpoint_age_ = 0;
  bool has_setpoint_ = false;
  Wrench<Scalar> wrench_ = Wrench<Scalar>::Zero();  ///< filtered
  bool has_wrench_ = false;
  Angles aim_ = Angles::Zero();  ///< full correction for the last good input
  Scalar fade_ = 0;              ///< 0 to 1
  JointGuards<Scalar, Joints> guards_;
};

}  // namespace flexcomp
