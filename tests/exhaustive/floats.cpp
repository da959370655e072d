// Every float there is, as each scalar input of the limiter and of the tick.
//
// Usage: exhaustive_floats [STRIDE [CHECK]]
//
// STRIDE 1 tries all 2^32 values (minutes to hours), 16411 (the default) some 260,000 and those
// around every power of two, zero and infinity. CHECK is the begin of the names of those to be
// done.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include "core/test_robots.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/table_builder.hpp"
#include "sweep.hpp"

using namespace flexcomp;
using flexcomp::exhaustive::sweep;
using flexcomp::exhaustive::Tally;

namespace {

using Core = Compensator<float, 6>;

constexpr float kPeriod = 1e-3F;
constexpr CorrectionLimits<float> kLimits = {0.01F, 0.1F, 5.0F};
constexpr float kInf = std::numeric_limits<float>::infinity();

std::uint32_t stride = 16411;
std::string chosen;
bool all_right = true;

template <typename Check>
void report(const std::string& name, const Check& check) {
  if (name.compare(0, chosen.size(), chosen) != 0) {
    return;
  }
  const Tally tally = sweep(stride, check);
  std::printf("  %-36s %10llu values  %s", name.c_str(),
              static_cast<unsigned long long>(tally.tried), tally.wrong == 0 ? "ok\n" : "");
  if (tally.wrong != 0) {
    std::printf("WRONG for %llu, first %.9g (0x%08X)\n",
                static_cast<unsigned long long>(tally.wrong),
                static_cast<double>(exhaustive::float_of(tally.first_wrong)), tally.first_wrong);
  }
  std::fflush(stdout);
  all_right = all_right && tally.wrong == 0;
}

/// Is a third value in a row within value, rate and acceleration limits? In double, where
/// differences of floats are exact; limits and period are rounded once each in the limiter.
bool is_within(const CorrectionLimits<float>& limits, float period, double before, double now,
               double next) {
  constexpr double kSlack = 1 + 4 * static_cast<double>(std::numeric_limits<float>::epsilon());
  const auto t = static_cast<double>(period);
  return std::isfinite(next) && std::fabs(next) <= static_cast<double>(limits.value) &&
         std::fabs(next - now) <= kSlack * static_cast<double>(limits.rate) * t &&
         std::fabs(next - 2 * now + before) <=
             kSlack * static_cast<double>(limits.acceleration) * t * t;
}

/// A guard in some state, and its last two values.
struct Moving {
  Guard<float> guard;
  double before = 0;
  double now = 0;

  void advance(float target, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      before = now;
      now = static_cast<double>(guard.advance(target));
    }
  }

  /// One tick to `target` keeps the limits; a target that is no number counts as the value.
  bool keeps_limits(float target) const {
    Moving next = *this;
    const float value = next.guard.advance(target);
    Guard<float> stays = guard;
    const bool right = std::isfinite(target) || value == stays.advance(static_cast<float>(now));
    return right && is_within(kLimits, kPeriod, before, now, static_cast<double>(value));
  }
};

void sweep_limiter_targets() {
  Moving rest;
  static_cast<void>(rest.guard.configure(kLimits, kPeriod));
  Moving starting = rest;
  starting.advance(1, 7);
  Moving fast = rest;
  fast.advance(1, 60);
  Moving braking = fast;
  braking.advance(-1, 5);
  Moving at_limit = rest;
  at_limit.advance(1, 1000);
  const auto from = [](const char* name, const Moving& state) {
    report(name, [state](float target) { return state.keeps_limits(target); });
  };
  from("limiter.target from rest", rest);
  from("limiter.target starting", starting);
  from("limiter.target at full speed", fast);
  from("limiter.target braking", braking);
  from("limiter.target at the limit", at_limit);
}

/// The rule that `Guard::configure` documents, in double; where rounding decides, either answer
/// will do.
bool is_answer_right(const CorrectionLimits<float>& limits, float period, bool accepted) {
  for (const float number : {limits.value, limits.rate, limits.acceleration, period}) {
    if (!(number > 0) || !std::isfinite(number)) {
      return !accepted;
    }
  }
  constexpr double kBand = 1e-5;
  constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
  constexpr auto kLeast = static_cast<double>(std::numeric_limits<float>::min());
  const double value = static_cast<double>(limits.value);
  const double unit = value * static_cast<double>(std::numeric_limits<float>::epsilon());
  const double t = static_cast<double>(period);
  const double step = static_cast<double>(limits.rate) * t;
  const double change = static_cast<double>(limits.acceleration) * t * t;
  // Above 1: accepted, below: refused.
  const double margins[] = {kMost / (2 * value), unit / kLeast, change / (128 * unit),
                            64 * step / change, kMost / change, kMost / step,
                            // A value in between must have a number in full precision too.
                            change / kLeast, step / kLeast};
  const double margin = *std::min_element(std::begin(margins), std::end(margins));
  return std::fabs(margin - 1) < kBand || accepted == (margin > 1);
}

/// Limits that are accepted are kept, however wild the targets.
bool configures_rightly(const CorrectionLimits<float>& limits, float period) {
  Moving moving;
  const bool accepted = moving.guard.configure(limits, period) == Result::ok;
  if (!is_answer_right(limits, period, accepted)) {
    return false;
  }
  for (const float target : {kInf, limits.value, -3e38F, 3e38F, -limits.value, 0.0F}) {
    for (int i = 0; accepted && i < 2; ++i) {
      const auto next = static_cast<double>(moving.guard.advance(target));
      if (!is_within(limits, period, moving.before, moving.now, next)) {
        return false;
      }
      moving.before = moving.now;
      moving.now = next;
    }
  }
  return true;
}

void sweep_limiter_configuration() {
  report("limits.value", [](float v) { return configures_rightly({v, 0.1F, 5.0F}, kPeriod); });
  report("limits.rate", [](float v) { return configures_rightly({0.01F, v, 5.0F}, kPeriod); });
  report("limits.acceleration", [](float v) {
    return configures_rightly({0.01F, 0.1F, v}, kPeriod);
  });
  report("limits.period", [](float v) { return configures_rightly(kLimits, v); });
}

/// A compensator that corrects, on a program that stands still, and a good input for it.
class Running {
 public:
  Running() : words_(1 << 14) {
    std::array<JointVector<float, 6>, 8> program;
    for (std::size_t i = 0; i < program.size(); ++i) {
      program[i] = test::loop_angles<float>(0.05 * static_cast<double>(i));
    }
    std::size_t size = 0;
    bool ready = build_path_table<float, 6>(test::kr270<float>(), program.data(), program.size(),
                                            {1600, 20, 1e-5F, 1e-5F, 0}, words_.data(),
                                            4 * words_.size(), &size) == Result::ok &&
                 Table::open(words_.data(), size, &table_) == Result::ok &&
                 core_.configure(config_) == Result::ok && core_.set_table(table_) == Result::ok;
    input_.setpoint = test::loop_angles<float>(0.1);
    input_.setpoint_age = 1e-3F;
    input_.wrench << 440, 1370, 635, 0, 3, 10.5F;
    input_.wrench_age = 2e-3F;
    run(20);
    ready = ready && core_.arm() == Result::ok;
    run(1000);
    header_ = table_.header();
    if (!ready || core_.state() != State::active) {
      std::fputs("exhaustive_floats: it does not run\n", stderr);
      std::exit(3);
    }
  }

  /// From full correction to off, at rest, with a fade of so many periods.
  int ticks_to_fade_out(float periods) {
    constexpr int kMost = 2'000'000;
    Core::Config slow = config_;
    slow.fade_time = periods * kPeriod;
    bool ready = core_.configure(slow) == Result::ok && core_.set_table(table_) == Result::ok;
    run(20);
    ready = ready && core_.arm() == Result::ok;
    for (int i = 0; ready && i < kMost && last_.state != State::active; ++i) {
      run(1);
    }
    core_.disarm();
    int ticks = 0;
    for (; ready && ticks < kMost && last_.state != State::off; ++ticks) {
      run(1);
    }
    return ticks;
  }

  /// A tick with `value` at `place` of the input, and a good one after it: what is wrong with the
  /// value is said, all that comes out is finite and within limits, and nothing stays behind.
  bool bears(std::size_t place, float value) const {
    Core core = core_;
    Core::Input input = input_;
    number(&input, place) = value;
    const Core::Output first = core.tick(input);
    const Core::Output second = core.tick(input_);
    const std::uint32_t faults = first.status & kFaultBits;
    const bool state_fits = first.state == (faults != 0 ? State::holding : State::active);
    return state_fits && says_what_is_wrong(place, value, faults) && is_sound(first, last_) &&
           is_sound(second, first);
  }

 private:
  static float& number(Core::Input* input, std::size_t place) {
    if (place < 6) {
      return input->setpoint[static_cast<Eigen::Index>(place)];
    }
    if (place < 12) {
      return input->wrench[static_cast<Eigen::Index>(place - 6)];
    }
    return place == 12 ? input->setpoint_age : input->wrench_age;
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      last_ = core_.tick(input_);
    }
  }

  /// From `before`, at rest.
  static bool is_sound(const Core::Output& output, const Core::Output& before) {
    bool sound = output.setpoint.allFinite() && output.deflection.allFinite();
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto now = static_cast<double>(before.correction[i]);
      const auto next = static_cast<double>(output.correction[i]);
      sound = sound && std::isfinite(next) &&
              std::fabs(next) <= static_cast<double>(kLimits.value) &&
              std::fabs(next - now) <= static_cast<double>(kLimits.rate * kPeriod);
    }
    return sound;
  }

  /// Is the answer the expected one? Within rounding of a limit either will do.
  static bool fits(double margin, bool said) {
    constexpr double kBand = 1e-5;
    return std::fabs(margin - 1) < kBand || said == (margin > 1);
  }

  bool says_what_is_wrong(std::size_t place, float value, std::uint32_t faults) const {
    if (place == 12) {
      return faults == (value >= 0 && value <= config_.setpoint_age_limit ? 0U : kSetpointStale);
    }
    if (place == 13) {
      return faults == (value >= 0 && value <= config_.wrench_age_limit ? 0U : kWrenchStale);
    }
    if (!std::isfinite(value)) {
      return faults == (place < 6 ? kSetpointNotFinite : kWrenchNotFinite);
    }
    return place < 6 ? says_where_the_setpoint_is(place, value, faults)
                     : says_how_large_the_wrench_is(place - 6, value, faults);
  }

  bool says_where_the_setpoint_is(std::size_t joint, float value, std::uint32_t faults) const {
    constexpr std::uint32_t kPossible =
        kSetpointOutOfRange | kSetpointJump | std::uint32_t{kOutsideChart};
    const bool outside = value < header_.joint_lower[joint] || value > header_.joint_upper[joint];
    const double step =
        std::fabs(static_cast<double>(value) -
                  static_cast<double>(input_.setpoint[static_cast<Eigen::Index>(joint)]));
    const double reach =
        2 * (static_cast<double>(kPeriod) + static_cast<double>(input_.setpoint_age));
    return (faults & ~kPossible) == 0 && ((faults & kSetpointOutOfRange) != 0) == outside &&
           fits(step / reach, (faults & kSetpointJump) != 0);
  }

  bool says_how_large_the_wrench_is(std::size_t component, float value,
                                    std::uint32_t faults) const {
    const Eigen::Index first = component < 3 ? 0 : 3;
    Eigen::Vector3d vector = input_.wrench.segment<3>(first).cast<double>();
    vector[static_cast<Eigen::Index>(component) - first] = static_cast<double>(value);
    const double range = component < 3 ? 5000 : 500;
    return (faults & ~std::uint32_t{kWrenchOutOfRange}) == 0 &&
           fits(vector.norm() / range, faults != 0);
  }

  std::vector<std::uint32_t> words_;
  Table table_;
  TableHeader header_{};
  const Core::Config config_ = test::compensator_config();
  Core core_;
  Core::Input input_{};
  Core::Output last_{};
};

/// The longest fade there may be ends, although its steps are all but lost to rounding near 1.
void try_the_longest_fade() {
  const std::string name = "fade.of a million ticks";
  if (name.compare(0, chosen.size(), chosen) != 0) {
    return;
  }
  const int ticks = Running().ticks_to_fade_out(1e6F);
  const bool right = ticks > 900'000 && ticks < 1'100'000;
  std::printf("  %-36s %10d ticks   %s\n", name.c_str(), ticks, right ? "ok" : "WRONG");
  all_right = all_right && right;
}

void sweep_tick_inputs() {
  static const char* const kNames[] = {"tick.setpoint 1",   "tick.setpoint 2", "tick.setpoint 3",
                                       "tick.setpoint 4",   "tick.setpoint 5", "tick.setpoint 6",
                                       "tick.fx",           "tick.fy",         "tick.fz",
                                       "tick.mx",           "tick.my",         "tick.mz",
                                       "tick.setpoint age", "tick.wrench age"};
  const Running running;
  for (std::size_t place = 0; place < std::size(kNames); ++place) {
    report(kNames[place], [&](float value) { return running.bears(place, value); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    stride = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  }
  if (argc > 2) {
    chosen = argv[2];
  }
  if (stride == 0) {
    std::fputs("exhaustive_floats: the stride must be a number above zero\n", stderr);
    return 2;
  }
  sweep_limiter_targets();
  sweep_limiter_configuration();
  sweep_tick_inputs();
  try_the_longest_fade();
  return all_right ? 0 : 1;
}
