#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "cases.hpp"
#include "core/test_robots.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::cases;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;
using flexcomp::test::loop_angles;

namespace {

using Core = Compensator<float, 6>;
using Angles = JointVector<float, 6>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kPeriod = 1e-3F;
constexpr CorrectionLimits<float> kLimits = {0.01F, 0.1F, 5.0F};
constexpr double kTurn = 6.28318530717958647692;
constexpr int kRound = 20000;  // ticks for a round of the program
constexpr std::size_t kHeaderWords = sizeof(TableHeader) / 4;

std::vector<std::uint32_t> build_table(const RobotModel<float, 6>& model, float largest_gain) {
  std::vector<Angles> program;
  for (int i = 0; i <= 120; ++i) {
    program.push_back(loop_angles<float>(kTurn * (i % 120) / 120));
  }
  std::vector<std::uint32_t> words(1 << 16);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(
      Result::ok, (build_path_table<float, 6>(model, program.data(), program.size(),
                                              {2000, 50, 5e-6F, 5e-6F, largest_gain}, words.data(),
                                              4 * words.size(), &size)));
  words.resize(size / 4);
  return words;
}

const std::vector<std::uint32_t>& table_words() {
  static const std::vector<std::uint32_t> kWords = build_table(kr270<float>(), 0);
  return kWords;
}

Table open(const std::vector<std::uint32_t>& words) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  return table;
}

Core::Config good_config() {
  Core::Config config = flexcomp::test::compensator_config();
  config.ready_ticks = 5;
  return config;
}

Core::Input input_at(int tick) {
  Core::Input input;
  input.setpoint = loop_angles<float>(kTurn * tick / kRound);
  input.setpoint_age = 0.001F;
  input.wrench << 440, 1370, 635, 0, 3, 10.5F;
  input.wrench_age = 0.002F;
  return input;
}

/// A compensator on the program, armed and settled.
struct Running {
  Core core;
  int now = 0;
  Core::Output output;

  explicit Running(const Core::Config& config = good_config()) {
    TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
    TEST_ASSERT_EQUAL(Result::ok, core.set_table(open(table_words())));
    run(20);
    TEST_ASSERT_EQUAL(Result::ok, core.arm());
    run(1000);
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      output = core.tick(input_at(now++));
    }
  }

  void run_with(int ticks, void (*spoil)(Core::Input*)) {
    for (int i = 0; i < ticks; ++i) {
      Core::Input input = input_at(now++);
      spoil(&input);
      output = core.tick(input);
    }
  }
};

void it_corrects_by_what_the_model_says() {
  Running running;
  TEST_ASSERT_TRUE(running.output.state == State::active);
  TEST_ASSERT_EQUAL_HEX32(0, running.output.status & kFaultBits);
  const Core::Input input = input_at(running.now - 1);
  const auto exact = setpoint_correction<double, 6>(kr270<double>(), input.setpoint.cast<double>(),
                                                    input.wrench.cast<double>());
  const auto twist = deflection<double, 6>(kr270<double>(), input.setpoint.cast<double>(),
                                           input.wrench.cast<double>())
                         .tcp;
  // The tolerance of the table over the shortest lever that matters, and the lag of the limiter.
  TEST_ASSERT_TRUE((running.output.correction.cast<double>() - exact).cwiseAbs().maxCoeff() < 2e-5);
  TEST_ASSERT_TRUE((running.output.deflection.cast<double>() - twist).cwiseAbs().maxCoeff() < 1e-5);
  TEST_ASSERT_TRUE(
      (running.output.setpoint - input.setpoint - running.output.correction).isZero(1e-6F));
}

void off_it_passes_the_setpoint_on() {
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(good_config()));
  const Core::Output output = core.tick(input_at(7));
  TEST_ASSERT_TRUE(output.state == State::off);
  TEST_ASSERT_TRUE(output.setpoint == input_at(7).setpoint);
  TEST_ASSERT_TRUE(output.correction.isZero(0));
}

void the_gain_scales_the_correction() {
  Core::Config config = good_config();
  Running full(config);
  config.gain = 0.5F;
  Running half(config);
  TEST_ASSERT_TRUE((full.output.correction - 2 * half.output.correction).cwiseAbs().maxCoeff() <
                   1e-5F);
}

/// A first-order low-pass answers a step with 1 − e^(−2π f t).
void the_filter_answers_a_step_as_a_low_pass_does() {
  Core::Config config = good_config();
  config.filter_cutoff = 2;
  Running running(config);
  const float settled = running.output.deflection[1];
  running.run_with(80, [](Core::Input* input) { input->wrench.setZero(); });
  const double expected = std::exp(-kTurn * 2 * 0.08);
  TEST_ASSERT_DOUBLE_WITHIN(0.02, expected,
                            static_cast<double>(running.output.deflection[1] / settled));
}

struct Fault {
  const char* name;
  std::uint32_t bit;
  void (*spoil)(Core::Input*);
};

constexpr Fault kFaults[] = {
    {"setpoint NaN", kSetpointNotFinite, [](Core::Input* i) { i->setpoint[2] = kNan; }},
    {"setpoint infinite", kSetpointNotFinite, [](Core::Input* i) { i->setpoint[0] = -kInf; }},
    {"setpoint old", kSetpointStale, [](Core::Input* i) { i->setpoint_age = 0.005F; }},
    {"setpoint age NaN", kSetpointStale, [](Core::Input* i) { i->setpoint_age = kNan; }},
    {"setpoint from the future", kSetpointStale, [](Core::Input* i) { i->setpoint_age = -1e-3F; }},
    {"setpoint beyond a limit", kSetpointOutOfRange, [](Core::Input* i) { i->setpoint[1] = 2.6F; }},
    {"setpoint huge", kSetpointOutOfRange, [](Core::Input* i) { i->setpoint[4] = 3e38F; }},
    {"wrench NaN", kWrenchNotFinite, [](Core::Input* i) { i->wrench[5] = kNan; }},
    {"wrench infinite", kWrenchNotFinite, [](Core::Input* i) { i->wrench[0] = kInf; }},
    {"wrench old", kWrenchStale, [](Core::Input* i) { i->wrench_age = 0.011F; }},
    {"wrench age infinite", kWrenchStale, [](Core::Input* i) { i->wrench_age = kInf; }},
    {"force saturated", kWrenchOutOfRange, [](Core::Input* i) { i->wrench[2] = 5001; }},
    {"force huge", kWrenchOutOfRange, [](Core::Input* i) { i->wrench[1] = 3e38F; }},
    {"moment saturated", kWrenchOutOfRange, [](Core::Input* i) { i->wrench[4] = -501; }},
    {"moments too large together", kWrenchOutOfRange,
     [](Core::Input* i) { i->wrench.tail<3>().setConstant(300); }},
    {"off the program", kOutsideChart, [](Core::Input* i) { i->setpoint[5] += 0.05F; }},
    {"caller's fault", kExternalFault, [](Core::Input* i) { i->external_fault = true; }},
};

void every_fault_is_named_held_faded_and_latched() {
  for (const Fault& fault : kFaults) {
    Running running;
    const Angles before = running.output.correction;
    running.run_with(10, fault.spoil);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::holding, fault.name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(fault.bit, running.output.status & fault.bit, fault.name);
    TEST_ASSERT_TRUE_MESSAGE((running.output.correction - before).cwiseAbs().maxCoeff() < 2e-4F,
                             fault.name);
    TEST_ASSERT_TRUE_MESSAGE(running.output.setpoint.allFinite(), fault.name);
    running.run_with(60, fault.spoil);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::fading_out, fault.name);
    running.run_with(500, fault.spoil);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::latched, fault.name);
    TEST_ASSERT_TRUE_MESSAGE(running.output.correction.isZero(0), fault.name);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(fault.bit, running.output.latched_faults & fault.bit,
                                    fault.name);
    running.run(100);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::latched, fault.name);
    TEST_ASSERT_EQUAL(Result::not_ready, running.core.arm());
    TEST_ASSERT_EQUAL(Result::ok, running.core.reset());
    TEST_ASSERT_EQUAL(Result::ok, running.core.arm());
    running.run(1000);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::active, fault.name);
    TEST_ASSERT_EQUAL_HEX32(0, running.output.latched_faults);
  }
}

void a_short_fault_is_ridden_out() {
  for (const Fault& fault : kFaults) {
    Running running;
    running.run_with(3, fault.spoil);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::holding, fault.name);
    running.run(20);
    TEST_ASSERT_TRUE_MESSAGE(running.output.state == State::active, fault.name);
  }
}

/// Twelve ticks over and over, of which the first `bad` are spoiled, for five seconds at most;
/// the ticks until it latches, 0 if it does not.
int ticks_until_latched(void (*spoil)(Core::Input*), int bad) {
  Running running;
  for (int tick = 1; tick <= 5000; ++tick) {
    running.run_with(
        1, tick % 12 < bad ? spoil : [](Core::Input*) {});
    if (running.output.state == State::latched) {
      return tick;
    }
  }
  return 0;
}

/// Whatever is wrong with the input: one good tick in twelve does not keep a correction that is
/// never renewed but then.
void a_fault_that_comes_and_goes_fades_out_when_more_ticks_are_bad_than_good() {
  for (const Fault& fault : kFaults) {
    const int straight = ticks_until_latched(fault.spoil, 12);
    const int flickering = ticks_until_latched(fault.spoil, 11);
    TEST_ASSERT_GREATER_THAN_MESSAGE(0, flickering, fault.name);
    // The hold time by 2 × 11/12 − 1, and no good tick in which to stop fading.
    TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(straight + 13, flickering, fault.name);
    TEST_ASSERT_GREATER_THAN_MESSAGE(0, ticks_until_latched(fault.spoil, 7), fault.name);
  }
}

void a_fault_that_comes_and_goes_is_ridden_out_while_more_ticks_are_good_than_bad() {
  for (const Fault& fault : kFaults) {
    // A setpoint that jumps is seen on its way back, too.
    TEST_ASSERT_EQUAL_MESSAGE(0, ticks_until_latched(fault.spoil, 1), fault.name);
    TEST_ASSERT_EQUAL_MESSAGE(0, ticks_until_latched(fault.spoil, 5), fault.name);
  }
}

/// Two bursts, each shorter than the hold time, with as many good ticks between them.
void bursts_that_the_time_between_them_makes_up_for_leave_nothing_behind() {
  Running running;
  for (int i = 0; i < 20; ++i) {
    running.run_with(45, kFaults[7].spoil);
    TEST_ASSERT_TRUE(running.output.state == State::holding);
    running.run(45);
    TEST_ASSERT_TRUE(running.output.state == State::active);
  }
  running.run_with(50, kFaults[7].spoil);
  TEST_ASSERT_TRUE(running.output.state == State::holding);
  running.run_with(1, kFaults[7].spoil);
  TEST_ASSERT_TRUE(running.output.state == State::fading_out);
}

void a_jump_of_the_setpoint_is_noticed() {
  Running running;
  running.now += 300;  // along the program, but faster than the joints can move
  running.run(1);
  TEST_ASSERT_EQUAL_HEX32(kSetpointJump, running.output.status & kSetpointJump);
  TEST_ASSERT_TRUE(running.output.state == State::holding);
  running.run(50);
  TEST_ASSERT_TRUE(running.output.state == State::active);
}

void an_unusable_setpoint_is_replaced_by_the_last_usable_one() {
  Running running;
  const Angles last = input_at(running.now - 1).setpoint;
  running.run_with(1, [](Core::Input* input) { input->setpoint.setConstant(kNan); });
  TEST_ASSERT_TRUE((running.output.setpoint - running.output.correction - last).isZero(1e-6F));
}

/// Is it a jump if the joints then move, at their speed, for two and a half periods?
bool jumps_after(const Core::Input& spoilt) {
  Core core;
  const Core::Config config = good_config();
  TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
  Core::Input input = input_at(0);  // its age is a period
  core.tick(input);
  core.tick(spoilt);
  input.setpoint += 2.5F * kPeriod * Angles(config.joint_speed);
  return (core.tick(input).status & kSetpointJump) != 0;
}

void where_the_age_of_a_setpoint_is_not_known_it_is_a_period_older_than_the_last() {
  Core::Input spoilt = input_at(0);
  TEST_ASSERT_TRUE(jumps_after(spoilt));
  spoilt.setpoint_age = -kPeriod;
  TEST_ASSERT_FALSE(jumps_after(spoilt));
  spoilt = input_at(0);
  spoilt.setpoint[2] = kNan;
  TEST_ASSERT_FALSE(jumps_after(spoilt));
}

void before_any_usable_setpoint_the_output_says_not_to_use_it() {
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(good_config()));
  Core::Input input = input_at(0);
  input.setpoint[3] = kNan;
  const Core::Output output = core.tick(input);
  TEST_ASSERT_TRUE((output.status & kNoSetpoint) != 0);
  TEST_ASSERT_TRUE(output.setpoint.allFinite());
  TEST_ASSERT_FALSE((core.tick(input_at(1)).status & kNoSetpoint) != 0);
}

void it_arms_only_after_enough_good_inputs_in_a_row() {
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(good_config()));
  TEST_ASSERT_EQUAL(Result::no_table, core.arm());
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(open(table_words())));
  for (int i = 0; i < 4; ++i) {
    core.tick(input_at(i));
  }
  TEST_ASSERT_EQUAL(Result::not_ready, core.arm());
  Core::Input bad = input_at(4);
  bad.wrench[0] = kNan;
  core.tick(bad);
  for (int i = 5; i < 9; ++i) {
    core.tick(input_at(i));
  }
  TEST_ASSERT_EQUAL(Result::not_ready, core.arm());
  core.tick(input_at(9));
  TEST_ASSERT_EQUAL(Result::ok, core.arm());
  TEST_ASSERT_EQUAL(Result::not_ready, core.arm());
}

void disarming_fades_out_and_can_be_armed_again() {
  Running running;
  running.core.disarm();
  TEST_ASSERT_TRUE(running.core.state() == State::fading_out);
  running.run(600);
  TEST_ASSERT_TRUE(running.output.state == State::off);
  TEST_ASSERT_TRUE(running.output.correction.isZero(0));
  TEST_ASSERT_EQUAL(Result::not_ready, running.core.reset());
  TEST_ASSERT_EQUAL(Result::ok, running.core.arm());
  running.core.disarm();
  running.run(600);
  TEST_ASSERT_TRUE(running.output.state == State::off);
  running.core.disarm();
  TEST_ASSERT_TRUE(running.core.state() == State::off);
}

void tables_of_other_robots_and_unsafe_gains_are_refused() {
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(good_config()));
  TEST_ASSERT_EQUAL(Result::no_table, core.set_table(Table()));
  RobotModel<float, 6> other = kr270<float>();
  other.joints[2].compliance *= 1.1F;
  TEST_ASSERT_EQUAL(Result::table_other_model, core.set_table(open(build_table(other, 0))));
  const std::vector<std::uint32_t> timid = build_table(kr270<float>(), 0.8F);
  TEST_ASSERT_EQUAL(Result::gain_too_high, core.set_table(open(timid)));
  Core::Config config = good_config();
  config.gain = 0.8F;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(open(timid)));
}

void a_table_can_be_changed_while_correcting() {
  Running running;
  const std::vector<std::uint32_t> copy(table_words().begin(), table_words().end());
  const Angles before = running.output.correction;
  TEST_ASSERT_EQUAL(Result::ok, running.core.set_table(open(copy)));
  running.run(1);
  TEST_ASSERT_TRUE(running.output.state == State::active);
  TEST_ASSERT_TRUE((running.output.correction - before).cwiseAbs().maxCoeff() < 1e-5F);
}

void near_the_edge_of_the_table_the_correction_shrinks() {
  Running running;
  const float full = running.output.correction.norm();
  for (int i = 0; i < 400; ++i) {
    running.run_with(1, [](Core::Input* input) { input->setpoint[5] += 0.005F; });
  }
  TEST_ASSERT_EQUAL_HEX32(kChartEdge, running.output.status & kChartEdge);
  TEST_ASSERT_TRUE(running.output.state == State::active);
  TEST_ASSERT_TRUE(running.output.correction.norm() < 0.95F * full);
  TEST_ASSERT_TRUE(running.output.correction.norm() > 0.3F * full);
}

void the_correction_at_the_tcp_is_limited() {
  Core::Config config = good_config();
  config.deflection_limit = 1e-4F;
  Running running(config);
  TEST_ASSERT_EQUAL_HEX32(kDeflectionLimited, running.output.status & kDeflectionLimited);
  const auto jacobian = geometric_jacobian<float, 6>(
      forward_kinematics<float, 6>(kr270<float>(), input_at(running.now - 1).setpoint));
  const float shift = (jacobian * running.output.correction).head<3>().norm();
  TEST_ASSERT_FLOAT_WITHIN(5e-6F, 1e-4F, shift);
}

void a_joint_at_its_largest_correction_says_so() {
  Core::Config config = good_config();
  for (auto& limits : config.limits) {
    limits.value = 1e-5F;
  }
  Running running(config);
  TEST_ASSERT_EQUAL_HEX32(kValueLimited, running.output.status & kValueLimited);
}

/// CRC-32 bit by bit, as IEEE 802.3 words it.
std::uint32_t crc32_of(const std::vector<std::uint32_t>& words) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint32_t word : words) {
    crc ^= word;  // little-endian bytes, least significant bit first
    for (int bit = 0; bit < 32; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

void set_crc(std::vector<std::uint32_t>* words) {
  (*words)[3] = 0;
  (*words)[3] = crc32_of(*words);
}

/// A table whose CRC is right but whose content is not: numbers so large that their products
/// overflow.
void numbers_that_cannot_be_computed_are_a_fault() {
  Running running;
  std::vector<std::uint32_t> words = table_words();
  const float huge = 3e38F;
  for (std::size_t i = kHeaderWords + 25; i < words.size(); ++i) {
    std::memcpy(&words[i], &huge, sizeof huge);
  }
  set_crc(&words);
  TEST_ASSERT_EQUAL(Result::ok, running.core.set_table(open(words)));
  running.run(10);
  TEST_ASSERT_EQUAL_HEX32(kNotComputable, running.output.status & kNotComputable);
  TEST_ASSERT_TRUE(running.output.state == State::holding);
  TEST_ASSERT_TRUE(running.output.setpoint.allFinite());
}

/// The same where the deflection can be computed and only the correction cannot.
void a_correction_that_cannot_be_computed_is_a_fault() {
  std::vector<std::uint32_t> words = build_table(kr270_with_everything<float>(), 0);
  constexpr std::size_t kStructureMotion = 25 + 36 + 6 + 21;  // in a record
  const std::size_t record = open(words).header().record_size;
  const float huge = 3e38F;
  for (std::size_t at = kHeaderWords + kStructureMotion; at < words.size(); at += record) {
    for (std::size_t i = 0; i < 36; ++i) {
      std::memcpy(&words[at + i], &huge, sizeof huge);
    }
  }
  set_crc(&words);
  Core::Config config = good_config();
  config.model_hash = model_hash(kr270_with_everything<float>());
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(open(words)));
  for (int i = 0; i < 20; ++i) {
    core.tick(input_at(i));
  }
  TEST_ASSERT_EQUAL(Result::ok, core.arm());
  const Core::Output output = core.tick(input_at(20));
  TEST_ASSERT_EQUAL_HEX32(kNotComputable, output.status & kNotComputable);
  TEST_ASSERT_TRUE(output.correction.isZero(0) && output.deflection.isZero(0));
}

void without_a_fade_it_corrects_at_once_as_fast_as_the_limits_allow() {
  Core::Config config = good_config();
  config.fade_time = 0;
  Core core;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(open(table_words())));
  for (int i = 0; i < 20; ++i) {
    core.tick(input_at(i));
  }
  TEST_ASSERT_EQUAL(Result::ok, core.arm());
  const Core::Output output = core.tick(input_at(20));
  TEST_ASSERT_TRUE(output.state == State::active);
  TEST_ASSERT_EQUAL_HEX32(kRateLimited, output.status & kRateLimited);
}

/// Where joint angles of opposite ends of the range make a chord of no length that has a number,
/// nothing lies on it.
void a_place_that_cannot_be_computed_is_outside_the_table() {
  Running running;
  std::vector<std::uint32_t> words = table_words();
  const std::size_t record = open(words).header().record_size;
  float angle = 3e38F;
  for (std::size_t at = kHeaderWords; at < words.size(); at += record, angle = -angle) {
    std::memcpy(&words[at], &angle, sizeof angle);
  }
  set_crc(&words);
  TEST_ASSERT_EQUAL(Result::ok, running.core.set_table(open(words)));
  running.run(10);
  TEST_ASSERT_EQUAL_HEX32(kOutsideChart, running.output.status & (kOutsideChart | kNotComputable));
  TEST_ASSERT_TRUE(running.output.state == State::holding);
}

void configurations_that_make_no_sense_are_refused() {
  using Change = void (*)(Core::Config*);
  const Change changes[] = {
      [](Core::Config* c) { c->period = 0; },
      [](Core::Config* c) { c->period = kNan; },
      [](Core::Config* c) { c->gain = 0; },
      [](Core::Config* c) { c->gain = 1.1F; },
      [](Core::Config* c) { c->gain = kNan; },
      [](Core::Config* c) { c->filter_cutoff = -1; },
      [](Core::Config* c) { c->filter_cutoff = kInf; },
      [](Core::Config* c) { c->force_range = 0; },
      [](Core::Config* c) { c->moment_range = kInf; },
      [](Core::Config* c) { c->force_range = 1e30F; },  // whose square is no number
      [](Core::Config* c) { c->setpoint_age_limit = -1; },
      [](Core::Config* c) { c->wrench_age_limit = kNan; },
      [](Core::Config* c) { c->joint_speed[4] = 0; },
      [](Core::Config* c) { c->joint_speed[4] = kNan; },
      [](Core::Config* c) { c->limits[5].rate = 0; },
      [](Core::Config* c) { c->deflection_limit = 0; },
      [](Core::Config* c) { c->chart_margin = 0; },
      [](Core::Config* c) { c->hold_time = -1; },
      [](Core::Config* c) { c->fade_time = kNan; },
      [](Core::Config* c) { c->fade_time = 1e30F; },
      // Steps of 1e-7 are lost near 1: the fade would never end.
      [](Core::Config* c) { c->fade_time = 1e7F * kPeriod; },
  };
  for (const Change change : changes) {
    Core::Config config = good_config();
    change(&config);
    Core core;
    TEST_ASSERT_EQUAL(Result::bad_config, core.configure(config));
  }
  Core core;
  TEST_ASSERT_EQUAL(Result::bad_config, core.configure(Core::Config{}));
}

void a_compensator_without_configuration_stays_off() {
  Core core;
  const Core::Output output = core.tick(input_at(0));
  TEST_ASSERT_TRUE(output.setpoint.allFinite());
  TEST_ASSERT_TRUE(output.correction.isZero(0));
  TEST_ASSERT_TRUE(output.state == State::off);
}

/// A float of any kind: sensible, extreme, denormal, not a number.
float any_float(std::mt19937* random) {
  switch ((*random)() % 6) {
    case 0:
      return kNan;
    case 1:
      return (*random)() % 2 == 0 ? kInf : -kInf;
    case 2:
      return std::numeric_limits<float>::denorm_min();
    default: {
      const auto bits = static_cast<std::uint32_t>((*random)());
      float value = 0;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
  }
}

/// Good inputs in stretches, broken by spoiled ones of every kind; armed, disarmed, reset and given
/// tables at random.
class HostileSequence {
 public:
  explicit HostileSequence(unsigned seed) : random_(seed) {}

  Core::Input next() {
    if (left_-- <= 0) {
      mode_ = static_cast<unsigned>(random_() % 8);
      left_ = static_cast<int>(random_() % 300);
      speed_ = static_cast<int>(random_() % 4);
    }
    now_ += speed_;
    Core::Input input = input_at(now_);
    const auto element = static_cast<Eigen::Index>(random_() % 6);
    switch (mode_) {
      case 0:
        input.setpoint[element] = any_float(&random_);
        break;
      case 1:
        input.wrench[element] = any_float(&random_);
        break;
      case 2:
        input.setpoint_age = any_float(&random_);
        break;
      case 3:
        input.wrench_age = any_float(&random_);
        break;
      case 4:
        now_ = static_cast<int>(random_() % kRound);
        break;
      case 5:
        input.wrench *= static_cast<float>(random_() % 5) - 2;
        break;
      default:
        break;
    }
    return input;
  }

  void command(Core* core) {
    switch (random_() % 2000) {
      case 0:
        core->disarm();
        break;
      case 1:
        static_cast<void>(core->set_table(open(table_words())));
        break;
      default:
        if (random_() % 50 == 0) {
          static_cast<void>(core->reset());
          static_cast<void>(core->arm());
        }
    }
  }

 private:
  std::mt19937 random_;
  unsigned mode_ = 7;
  int left_ = 0;
  int speed_ = 1;
  int now_ = 0;
};

void no_long_sequence_breaks_a_limit() {
  Running running;
  HostileSequence sequence(1);
  const double largest_step = static_cast<double>(kLimits.rate) * static_cast<double>(kPeriod);
  const double largest_change = static_cast<double>(kLimits.acceleration) *
                                static_cast<double>(kPeriod) * static_cast<double>(kPeriod);
  constexpr double kSlack = 1 + 4 * std::numeric_limits<float>::epsilon();
  JointVector<double, 6> before = running.output.correction.cast<double>();
  running.run(1);
  JointVector<double, 6> now = running.output.correction.cast<double>();
  bool seen[6] = {};
  for (int i = 0; i < cases(1000000); ++i) {
    sequence.command(&running.core);
    const Core::Output output = running.core.tick(sequence.next());
    const JointVector<double, 6> next = output.correction.cast<double>();
    seen[static_cast<int>(output.state)] = true;
    TEST_ASSERT_TRUE(output.setpoint.allFinite() && output.correction.allFinite() &&
                     output.deflection.allFinite());
    TEST_ASSERT_TRUE(next.cwiseAbs().maxCoeff() <= static_cast<double>(kLimits.value));
    TEST_ASSERT_TRUE((next - now).cwiseAbs().maxCoeff() <= kSlack * largest_step);
    TEST_ASSERT_TRUE((next - 2 * now + before).cwiseAbs().maxCoeff() <= kSlack * largest_change);
    before = now;
    now = next;
  }
  for (const bool state : seen) {
    TEST_ASSERT_TRUE_MESSAGE(state, "the sequence did not reach every state");
  }
}

/// Whatever went before, a lasting fault brings the correction to zero within the hold time, the
/// fade time and the time to move from the largest correction to zero.
void a_lasting_fault_reaches_zero_in_bounded_time() {
  const float move = kLimits.value / kLimits.rate + 2 * kLimits.rate / kLimits.acceleration;
  const auto bound = static_cast<int>((0.05F + 0.2F + move) / kPeriod) + 10;
  for (unsigned seed = 0; seed < cases(200U); ++seed) {
    Running running;
    HostileSequence sequence(seed);
    for (unsigned i = 0; i < 500 + 7 * seed; ++i) {
      sequence.command(&running.core);
      running.core.tick(sequence.next());
    }
    Core::Output output{};
    for (int i = 0; i < bound; ++i) {
      Core::Input input = sequence.next();
      input.external_fault = true;
      output = running.core.tick(input);
    }
    TEST_ASSERT_TRUE(output.correction.isZero(0));
  }
}

void every_state_and_bit_has_words() {
  for (int state = 0; state <= 5; ++state) {
    TEST_ASSERT_TRUE(describe(static_cast<State>(state)) != describe(static_cast<State>(99)));
  }
  for (const std::uint32_t bit :
       {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 16U, 17U, 18U, 19U, 20U}) {
    TEST_ASSERT_TRUE(describe(static_cast<StatusBit>(1U << bit)) !=
                     describe(static_cast<StatusBit>(1U << 31)));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(it_corrects_by_what_the_model_says);
  RUN_TEST(off_it_passes_the_setpoint_on);
  RUN_TEST(the_gain_scales_the_correction);
  RUN_TEST(the_filter_answers_a_step_as_a_low_pass_does);
  RUN_TEST(every_fault_is_named_held_faded_and_latched);
  RUN_TEST(a_short_fault_is_ridden_out);
  RUN_TEST(a_fault_that_comes_and_goes_fades_out_when_more_ticks_are_bad_than_good);
  RUN_TEST(a_fault_that_comes_and_goes_is_ridden_out_while_more_ticks_are_good_than_bad);
  RUN_TEST(bursts_that_the_time_between_them_makes_up_for_leave_nothing_behind);
  RUN_TEST(a_jump_of_the_setpoint_is_noticed);
  RUN_TEST(an_unusable_setpoint_is_replaced_by_the_last_usable_one);
  RUN_TEST(where_the_age_of_a_setpoint_is_not_known_it_is_a_period_older_than_the_last);
  RUN_TEST(before_any_usable_setpoint_the_output_says_not_to_use_it);
  RUN_TEST(it_arms_only_after_enough_good_inputs_in_a_row);
  RUN_TEST(disarming_fades_out_and_can_be_armed_again);
  RUN_TEST(tables_of_other_robots_and_unsafe_gains_are_refused);
  RUN_TEST(a_table_can_be_changed_while_correcting);
  RUN_TEST(near_the_edge_of_the_table_the_correction_shrinks);
  RUN_TEST(the_correction_at_the_tcp_is_limited);
  RUN_TEST(a_joint_at_its_largest_correction_says_so);
  RUN_TEST(numbers_that_cannot_be_computed_are_a_fault);
  RUN_TEST(a_correction_that_cannot_be_computed_is_a_fault);
  RUN_TEST(without_a_fade_it_corrects_at_once_as_fast_as_the_limits_allow);
  RUN_TEST(a_place_that_cannot_be_computed_is_outside_the_table);
  RUN_TEST(configurations_that_make_no_sense_are_refused);
  RUN_TEST(a_compensator_without_configuration_stays_off);
  RUN_TEST(no_long_sequence_breaks_a_limit);
  RUN_TEST(a_lasting_fault_reaches_zero_in_bounded_time);
  RUN_TEST(every_state_and_bit_has_words);
  return UNITY_END();
}
