#include <cstdlib>
#include <string>

#include "node/node_on_a_bus.hpp"
#include "rsi/link.hpp"

using namespace flexcomp;
using flexcomp::test::loop_angles;
using flexcomp::test::usual_config;
using flexcomp::test::usual_table;
using Due = RsiLink::Due;

namespace {

constexpr std::int64_t kCycle = 4'000'000;
constexpr double kToDegrees = 57.29577951308232;
constexpr RsiPeer kController = 1;
constexpr RsiPeer kOther = 2;

RsiConfig usual_rsi() {
  RsiConfig config;
  config.schema.wrench = "FT";
  config.schema.armed = "Arm";
  config.state_name = "State";
  return config;
}

NodeConfig trusting_config() {
  NodeConfig config = usual_config();
  config.require_identity = false;
  return config;
}

/// A robot controller with RSI running, in the words of its manual: it sends a telegram a cycle,
/// takes the answer that has its IPOC, and holds the correction where none comes. What it moves by
/// is held to the largest step from one cycle to the next.
class Controller {
 public:
  explicit Controller(const RsiConfig& config = usual_rsi(),
                      const NodeConfig& node_config = trusting_config())
      : link(config), config_(config), slot_(1 << 14) {
    node.use_memory({slot_.data(), slot_.size()}, {});
    TEST_ASSERT_EQUAL(Result::ok, node.configure(node_config));
    std::copy(usual_table().begin(), usual_table().end(), slot_.begin());
    Table opened;
    TEST_ASSERT_EQUAL(Result::ok, Table::open(slot_.data(), 4 * usual_table().size(), &opened));
    TEST_ASSERT_EQUAL(Result::ok, node.start_with(0, opened));
  }

  std::string telegram() const {
    const JointVector<double, 6> q = loop_angles<double>(phase_) * kToDegrees;
    const double noise = 3 * std::sin(1000 * phase_);
    std::string text = "<Rob Type=\"KUKA\">";
    for (const char* name : {"AIPos", "ASPos"}) {
      text += six(name, {"A1", "A2", "A3", "A4", "A5", "A6"}, {q[0], q[1], q[2], q[3], q[4], q[5]});
    }
    text += "<Delay D=\"" + std::to_string(late) + "\"/>";
    text += "<Arm>" + std::string(output ? "1" : "0") + "</Arm>";
    text += six("AxisCorrMon", {"A1", "A2", "A3", "A4", "A5", "A6"}, correction);
    text += six("FT", {"Fx", "Fy", "Fz", "Mx", "My", "Mz"},
                {fx + noise, 1370 - noise, 635, 0, 3, 10.5});
    return text + "<IPOC>" + std::to_string(ipoc) + "</IPOC></Rob>";
  }

  /// One cycle in which the telegram arrives and the answer too.
  CorrectedMessage cycle() {
    const std::string text = sent();
    TEST_ASSERT_EQUAL(Due::tick, link.receive(text, kController, &node, now));
    const CorrectedMessage corrected = tick();
    take(std::string(link.answer()));
    return corrected;
  }

  CorrectedMessage cycles(int count) {
    CorrectedMessage last;
    for (int i = 0; i < count; ++i) {
      last = cycle();
    }
    return last;
  }

  /// One cycle without a telegram that arrives, or without an answer that does.
  void cycle_without_telegram() {
    sent();
    tick();
    ++late;
  }
  void cycle_without_answer() {
    TEST_ASSERT_EQUAL(Due::tick, link.receive(sent(), kController, &node, now));
    tick();
    link.answer();
    ++late;
  }

  CorrectedMessage tick() {
    if (node.take_reset()) {
      link.forget_conflicts();
    }
    LinkState state;
    link.add_to(&state);
    node.set_link(state);
    const CorrectedMessage corrected = node.tick(now);
    link.observe(corrected);
    now += kCycle;
    return corrected;
  }

  void take(const std::string& answer) {
    TEST_ASSERT_TRUE(answer.find("<IPOC>" + std::to_string(ipoc) + "</IPOC>") != std::string::npos);
    const AxisAngles before = correction;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string name = " A" + std::to_string(i + 1) + "=\"";
      const double ak = std::strtod(answer.c_str() + answer.find(name) + name.size(), nullptr);
      correction[i] = config_.mode == RsiMode::absolute ? ak : correction[i] + ak;
      TEST_ASSERT_TRUE(std::abs(correction[i]) <= config_.largest + 1e-9);
      TEST_ASSERT_TRUE(std::abs(correction[i] - before[i]) <= config_.largest_step + 1e-9);
    }
    const std::size_t state_at = answer.find("<State>");
    told = state_at == std::string::npos
               ? -1
               : static_cast<int>(std::strtol(answer.c_str() + state_at + 7, nullptr, 10));
  }

  void bring_up() {
    cycles(20);
    output = true;
    cycles(80);
    TEST_ASSERT_EQUAL(State::active, node.state());
    TEST_ASSERT_TRUE(largest() > 0.01);
  }

  double largest() const {
    double most = 0;
    for (const double angle : correction) {
      most = std::max(most, std::abs(angle));
    }
    return most;
  }

  RsiLink link;
  Node node;
  std::int64_t now = 1'000'000'000;
  std::uint64_t ipoc = 4'208'163'634;
  std::uint64_t late = 0;
  bool output = false;
  double fx = 440;  ///< N
  AxisAngles correction{};
  int told = -1;

  const std::string& sent() {
    ipoc += 4;
    phase_ += test::kTurn / 3000;
    text_ = telegram();
    return text_;
  }

 private:
  static std::string six(const char* element, const std::array<const char*, 6>& names,
                         const std::array<double, 6>& values) {
    std::string text = std::string("<") + element;
    for (std::size_t i = 0; i < 6; ++i) {
      text += std::string(" ") + names[i] + "=\"" + std::to_string(values[i]) + "\"";
    }
    return text + "/>";
  }

  RsiConfig config_;
  std::vector<std::uint32_t> slot_;
  std::string text_;
  double phase_ = 0;
};

void nothing_moves_until_armed() {
  Controller controller;
  for (int i = 0; i < 100; ++i) {
    controller.cycle();
    TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
    TEST_ASSERT_EQUAL(State::off, controller.told);
  }
}

void the_answer_is_the_nodes_correction_in_degrees() {
  Controller controller;
  controller.bring_up();
  const CorrectedMessage corrected = controller.cycle();
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(0.6e-6,
                              (corrected.corrected[i] - corrected.uncorrected[i]) * kToDegrees,
                              controller.correction[i]);
  }
  TEST_ASSERT_EQUAL(State::active, controller.told);
}

void signs_of_the_axes_turn_setpoint_and_correction() {
  RsiConfig turned = usual_rsi();
  turned.axes.sign = {-1, 1, 1, 1, 1, 1};
  Controller controller(turned);
  const CorrectedMessage corrected = controller.cycles(30);
  TEST_ASSERT_DOUBLE_WITHIN(1e-3, -loop_angles<double>(test::kTurn * 30 / 3000)[0],
                            corrected.uncorrected[0]);
  CorrectedMessage bent = corrected;
  bent.corrected[0] += 1e-4;
  bent.corrected[1] += 1e-4;
  controller.link.observe(bent);
  const std::string text = controller.sent();
  controller.link.receive(text, kController, &controller.node, controller.now);
  controller.take(std::string(controller.link.answer()));
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, -1e-4 * kToDegrees, controller.correction[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1e-4 * kToDegrees, controller.correction[1]);
}

void the_output_arms_as_it_rises_and_disarms_as_it_falls() {
  Controller controller;
  controller.bring_up();
  controller.output = false;
  controller.cycles(80);
  TEST_ASSERT_EQUAL(State::off, controller.node.state());
  TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
  controller.output = true;
  controller.cycles(80);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
}

void an_output_that_is_high_from_the_start_does_not_arm() {
  Controller controller;
  controller.output = true;
  controller.cycles(100);
  TEST_ASSERT_EQUAL(State::off, controller.node.state());
}

void an_output_that_rose_while_the_controller_was_started_again_does_not_arm() {
  Controller controller;
  controller.cycles(30);
  controller.now += 600'000'000;
  controller.output = true;
  controller.cycles(100);
  TEST_ASSERT_EQUAL(State::off, controller.node.state());
}

void an_output_that_rises_before_the_node_is_ready_arms_when_it_is() {
  Controller controller;
  controller.cycles(2);
  controller.output = true;
  controller.cycles(2);
  TEST_ASSERT_EQUAL(State::off, controller.node.state());
  controller.cycles(100);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
}

/// Whoever asked no longer waits: it must not begin in the midst of a cut.
void a_node_that_becomes_ready_long_after_the_output_rose_is_not_armed() {
  Controller controller;
  controller.cycles(2);
  controller.fx = 1e6;  // out of range
  controller.output = true;
  controller.cycles(1400);
  controller.fx = 440;
  controller.cycles(600);
  TEST_ASSERT_EQUAL(State::off, controller.node.state());
}

void lost_telegrams_are_borne_until_they_are_too_many() {
  Controller controller;
  controller.bring_up();
  for (int i = 0; i < 3; ++i) {
    controller.cycle_without_telegram();
  }
  controller.cycles(10);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
  for (int i = 0; i < 60; ++i) {
    controller.cycle_without_telegram();
  }
  controller.cycles(60);
  TEST_ASSERT_EQUAL(State::latched, controller.node.state());
  TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
}

void a_latched_fault_is_taken_back_when_the_output_rises_again() {
  Controller controller;
  controller.bring_up();
  for (int i = 0; i < 60; ++i) {
    controller.cycle_without_telegram();
  }
  controller.cycles(100);
  TEST_ASSERT_EQUAL(State::latched, controller.node.state());
  controller.output = false;
  controller.cycles(20);
  TEST_ASSERT_EQUAL(State::latched, controller.node.state());
  controller.output = true;
  controller.cycles(80);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
}

void garbage_is_not_answered_and_changes_nothing() {
  Controller controller;
  controller.bring_up();
  for (const std::string& garbage : {std::string("\x00\xFF<Rob", 6), std::string(5000, 'x'),
                                     controller.telegram() + "x", std::string()}) {
    TEST_ASSERT_EQUAL(Due::nothing, controller.link.receive(garbage, kController, &controller.node,
                                                            controller.now));
  }
  LinkState state;
  controller.link.add_to(&state);
  TEST_ASSERT_EQUAL(4, state.setpoint.corrupt);
  controller.cycles(10);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
}

void telegrams_with_nan_are_garbage_and_their_lasting_fades_out() {
  Controller controller;
  controller.bring_up();
  for (int i = 0; i < 60; ++i) {
    std::string text = controller.sent();
    text.replace(text.find("<ASPos A1=\"") + 11, 4, "nan ");
    TEST_ASSERT_EQUAL(Due::nothing,
                      controller.link.receive(text, kController, &controller.node, controller.now));
    controller.tick();
  }
  TEST_ASSERT_EQUAL(State::latched, controller.node.state());
}

void a_repeated_telegram_gets_the_same_answer_and_no_tick() {
  Controller controller;
  controller.bring_up();
  const std::string text = controller.sent();
  controller.link.receive(text, kController, &controller.node, controller.now);
  controller.tick();
  const std::string answer(controller.link.answer());
  TEST_ASSERT_EQUAL(Due::the_same,
                    controller.link.receive(text, kController, &controller.node, controller.now));
  TEST_ASSERT_FALSE(controller.link.needs_answer());
  TEST_ASSERT_TRUE(controller.link.last_answer() == answer);
}

void a_telegram_of_a_wrong_ipoc_is_not_answered() {
  Controller controller;
  controller.bring_up();
  controller.ipoc -= 40;
  TEST_ASSERT_EQUAL(Due::nothing, controller.link.receive(controller.telegram(), kController,
                                                          &controller.node, controller.now));
  controller.ipoc += 40;
  controller.cycles(5);
  TEST_ASSERT_EQUAL(State::active, controller.node.state());
}

void a_second_controller_is_not_answered_and_ends_the_correction() {
  Controller controller;
  controller.bring_up();
  for (int i = 0; i < 20; ++i) {
    controller.cycle();
    TEST_ASSERT_EQUAL(Due::nothing, controller.link.receive(controller.telegram(), kOther,
                                                            &controller.node, controller.now));
  }
  controller.cycles(100);
  TEST_ASSERT_EQUAL(State::latched, controller.node.state());
  TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
}

void a_controller_that_was_started_again_begins_at_zero() {
  Controller controller;
  controller.bring_up();
  controller.now += 600'000'000;  // nothing ticks: the node still corrects
  controller.correction.fill(0);
  controller.ipoc += 600;
  for (int i = 0; i < 100; ++i) {
    controller.cycle();
    TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
  }
  TEST_ASSERT_TRUE(controller.node.is_at_zero());
  LinkState state;
  controller.link.add_to(&state);
  TEST_ASSERT_EQUAL(2, state.rsi.sessions);
}

/// The node was restarted while the controller held a correction.
void a_node_that_was_started_again_goes_to_zero_from_the_correction_that_is_there() {
  RsiConfig config = usual_rsi();
  config.schema.applied = "AxisCorrMon";
  Controller controller(config);
  controller.correction = {0.2, -0.3, 0.1, 0, 0.05, 0};
  controller.cycle();  // which checks the step
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.15, controller.correction[0]);
  controller.cycles(10);
  TEST_ASSERT_EQUAL_DOUBLE(0, controller.largest());
}

void the_limits_of_the_answers_hold_whatever_the_node_says() {
  RsiConfig config = usual_rsi();
  config.largest = 0.2;
  config.largest_step = 0.01;
  Controller controller(config);
  CorrectedMessage wild = controller.cycle();
  wild.corrected[0] += 1;
  wild.corrected[1] -= 1;
  for (int i = 0; i < 50; ++i) {
    controller.link.receive(controller.sent(), kController, &controller.node, controller.now);
    controller.link.observe(wild);
    controller.take(std::string(controller.link.answer()));  // which checks size and step
    controller.now += kCycle;
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.2, controller.correction[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, -0.2, controller.correction[1]);
  LinkState state;
  controller.link.add_to(&state);
  TEST_ASSERT_EQUAL(50, state.rsi.limited_answers);
  CorrectedMessage nonsense = wild;
  nonsense.corrected[3] = std::nan("");
  controller.link.receive(controller.sent(), kController, &controller.node, controller.now);
  controller.link.observe(nonsense);
  controller.take(std::string(controller.link.answer()));
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.2, controller.correction[0]);
}

RsiConfig relative_rsi() {
  RsiConfig config = usual_rsi();
  config.mode = RsiMode::relative;
  config.schema.needs_late = true;
  return config;
}

void relative_answers_add_up_to_the_correction() {
  Controller controller(relative_rsi());
  controller.bring_up();
  const CorrectedMessage corrected = controller.cycles(2000);
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-6,
                              (corrected.corrected[i] - corrected.uncorrected[i]) * kToDegrees,
                              controller.correction[i]);
  }
  controller.output = false;
  controller.cycles(100);
  TEST_ASSERT_TRUE(controller.largest() < 1e-9);
}

void relative_answers_that_were_late_are_made_up_for() {
  Controller controller(relative_rsi());
  controller.bring_up();
  for (int i = 0; i < 50; ++i) {
    controller.cycles(7);
    controller.cycle_without_answer();
    controller.cycles(5);
    controller.cycle_without_telegram();
  }
  controller.output = false;
  controller.cycles(100);
  TEST_ASSERT_TRUE(controller.largest() < 1e-9);
}

void late_answers_are_counted() {
  Controller controller;
  controller.cycles(5);
  controller.cycle_without_answer();
  controller.cycle_without_answer();
  controller.cycles(5);
  LinkState state;
  controller.link.add_to(&state);
  TEST_ASSERT_EQUAL(2, state.rsi.late_answers);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(nothing_moves_until_armed);
  RUN_TEST(the_answer_is_the_nodes_correction_in_degrees);
  RUN_TEST(signs_of_the_axes_turn_setpoint_and_correction);
  RUN_TEST(the_output_arms_as_it_rises_and_disarms_as_it_falls);
  RUN_TEST(an_output_that_is_high_from_the_start_does_not_arm);
  RUN_TEST(an_output_that_rose_while_the_controller_was_started_again_does_not_arm);
  RUN_TEST(an_output_that_rises_before_the_node_is_ready_arms_when_it_is);
  RUN_TEST(a_node_that_becomes_ready_long_after_the_output_rose_is_not_armed);
  RUN_TEST(lost_telegrams_are_borne_until_they_are_too_many);
  RUN_TEST(a_latched_fault_is_taken_back_when_the_output_rises_again);
  RUN_TEST(garbage_is_not_answered_and_changes_nothing);
  RUN_TEST(telegrams_with_nan_are_garbage_and_their_lasting_fades_out);
  RUN_TEST(a_repeated_telegram_gets_the_same_answer_and_no_tick);
  RUN_TEST(a_telegram_of_a_wrong_ipoc_is_not_answered);
  RUN_TEST(a_second_controller_is_not_answered_and_ends_the_correction);
  RUN_TEST(a_controller_that_was_started_again_begins_at_zero);
  RUN_TEST(a_node_that_was_started_again_goes_to_zero_from_the_correction_that_is_there);
  RUN_TEST(the_limits_of_the_answers_hold_whatever_the_node_says);
  RUN_TEST(relative_answers_add_up_to_the_correction);
  RUN_TEST(relative_answers_that_were_late_are_made_up_for);
  RUN_TEST(late_answers_are_counted);
  return UNITY_END();
}
