#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "flexcomp/compensator.hpp"
#include "monitor/live_node.hpp"
#include "monitor/view.hpp"
#include "node/node_status.hpp"
#include "unity_main.hpp"

using flexcomp::CorrectedMessage;
using flexcomp::HeartbeatMessage;
using flexcomp::SetpointMessage;
using flexcomp::WrenchMessage;
using flexcomp::monitor::LiveNode;
using flexcomp::monitor::Snapshot;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kBegin = 5'000'000'000;
constexpr std::uint8_t kActive = 2;

CorrectedMessage answer(std::uint32_t status, std::uint16_t node_status) {
  CorrectedMessage message;
  message.corrected = {0.101, 0.2, 0.3, 0.4, 0.5, 0.6};
  message.uncorrected = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  message.status = status;
  message.node_status = node_status;
  message.state = kActive;
  return message;
}

/// A node that answered `answers` setpoints, one every 4 ms, each `latency` after it.
LiveNode answered(int answers, std::int64_t latency) {
  LiveNode node(kBegin, std::nullopt);
  for (int i = 0; i < answers; ++i) {
    const std::int64_t now = kBegin + 4 * i * kMillisecond;
    node.take(SetpointMessage{}, now);
    node.take(answer(0, 0), now + latency);
  }
  return node;
}

void before_anything_is_heard_nothing_is_known() {
  const Snapshot snapshot = LiveNode(kBegin, std::nullopt).snapshot(kBegin);
  TEST_ASSERT_FALSE(snapshot.is_heard);
  TEST_ASSERT_TRUE(std::isnan(snapshot.correction[0]));
  TEST_ASSERT_TRUE(std::isnan(snapshot.mean_latency));
  TEST_ASSERT_TRUE(view(snapshot).find("nobody is heard") != std::string::npos);
}

void an_answer_gives_state_and_correction() {
  LiveNode node(kBegin, std::nullopt);
  node.take(answer(0, 0), kBegin);
  const Snapshot snapshot = node.snapshot(kBegin + 12 * kMillisecond);
  TEST_ASSERT_TRUE(snapshot.is_heard);
  TEST_ASSERT_EQUAL_STRING("active", snapshot.state.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-3, snapshot.correction[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, snapshot.correction[5]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.012, snapshot.time);
}

void faults_and_remarks_of_both_status_words_are_told_apart_and_in_words() {
  LiveNode node(kBegin, std::nullopt);
  node.take(answer(flexcomp::kWrenchStale | flexcomp::kRateLimited,
                   flexcomp::kTickLate | flexcomp::kWrenchSaturated),
            kBegin);
  const Snapshot snapshot = node.snapshot(kBegin);
  const std::vector<std::string> faults = {"wrench stale", "ticks late"};
  TEST_ASSERT_TRUE(faults == snapshot.faults);
  TEST_ASSERT_EQUAL(2, snapshot.remarks.size());
  TEST_ASSERT_TRUE(view(snapshot).find("wrench stale, ticks late") != std::string::npos);
}

void what_latched_it_comes_with_the_heartbeat() {
  LiveNode node(kBegin, std::nullopt);
  HeartbeatMessage beat;
  beat.state = 5;
  beat.latched_faults = flexcomp::kSetpointJump;
  beat.node_latched_faults = flexcomp::kBusFault;
  node.take(beat, kBegin);
  const Snapshot snapshot = node.snapshot(kBegin);
  TEST_ASSERT_EQUAL_STRING("latched", snapshot.state.c_str());
  TEST_ASSERT_EQUAL(2, snapshot.latched.size());
}

void a_node_that_falls_silent_is_said_to_be_so() {
  LiveNode node(kBegin, std::nullopt);
  node.take(answer(0, 0), kBegin);
  TEST_ASSERT_TRUE(node.snapshot(kBegin + 999 * kMillisecond).is_heard);
  const Snapshot later = node.snapshot(kBegin + 1000 * kMillisecond);
  TEST_ASSERT_FALSE(later.is_heard);
  TEST_ASSERT_TRUE(view(later).find("active, but not heard") != std::string::npos);
}

void latency_is_from_a_setpoint_to_its_answer_over_the_last_second() {
  LiveNode node = answered(100, 200'000);
  const std::int64_t end = kBegin + 400 * kMillisecond;
  node.take(SetpointMessage{}, end);
  node.take(answer(0, 0), end + 2 * kMillisecond);
  const Snapshot now = node.snapshot(end + 3 * kMillisecond);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, (100 * 0.2e-3 + 2e-3) / 101, now.mean_latency);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2e-3, now.largest_latency);
  TEST_ASSERT_EQUAL_DOUBLE(101, now.rate);
  const Snapshot later = node.snapshot(end + 2000 * kMillisecond);
  TEST_ASSERT_TRUE(std::isnan(later.mean_latency));
  TEST_ASSERT_EQUAL_DOUBLE(0, later.rate);
}

void a_setpoint_without_an_answer_is_counted_when_the_next_one_comes() {
  LiveNode node = answered(10, 200'000);
  node.take(SetpointMessage{}, kBegin + 40 * kMillisecond);
  TEST_ASSERT_EQUAL(0, node.snapshot(kBegin + 41 * kMillisecond).unanswered);
  node.take(SetpointMessage{}, kBegin + 44 * kMillisecond);
  node.take(answer(0, 0), kBegin + 45 * kMillisecond);
  const Snapshot snapshot = node.snapshot(kBegin + 46 * kMillisecond);
  TEST_ASSERT_EQUAL(1, snapshot.unanswered);
  TEST_ASSERT_EQUAL(12, snapshot.setpoints);
}

void with_a_model_it_says_what_the_springs_give() {
  // A single soft shoulder: 1 µrad/(N·m) about y, and an arm of 1 m along x.
  flexcomp::RobotModel<double, 6> model;
  model.joints[1].axis = flexcomp::Vector3<double>::UnitY();
  model.joints[1].compliance = 1e-6;
  model.tool.position = flexcomp::Vector3<double>(1, 0, 0);
  LiveNode node(kBegin, model);
  node.take(SetpointMessage{}, kBegin);
  TEST_ASSERT_TRUE(std::isnan(node.snapshot(kBegin).windup[1]));
  node.take(WrenchMessage{0, {0, 0, 1000, 0, 0, 0}, false}, kBegin);
  const Snapshot snapshot = node.snapshot(kBegin);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1e-3, snapshot.windup[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, snapshot.windup[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-3, snapshot.tcp[2]);
}

void the_view_fits_a_terminal_and_what_is_not_known_is_a_dash_or_null() {
  LiveNode node = answered(3, 200'000);
  node.take(HeartbeatMessage{}, kBegin);
  node.take(flexcomp::StatisticMessage{17, 4}, kBegin);
  const Snapshot snapshot = node.snapshot(kBegin + 20 * kMillisecond);
  const std::string text = view(snapshot);
  int width = 0;
  for (const char c : text) {
    const bool begins_a_letter = (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    width = c == '\n' ? 0 : width + (begins_a_letter ? 1 : 0);
    TEST_ASSERT_LESS_OR_EQUAL(80, width);
  }
  const nlohmann::ordered_json json = to_json(snapshot);
  TEST_ASSERT_TRUE(json["deflection"][0].is_null());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-3, json["correction"][0].get<double>());
  TEST_ASSERT_EQUAL(4, json["statistics"]["17"].get<int>());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(before_anything_is_heard_nothing_is_known);
  RUN_TEST(an_answer_gives_state_and_correction);
  RUN_TEST(faults_and_remarks_of_both_status_words_are_told_apart_and_in_words);
  RUN_TEST(what_latched_it_comes_with_the_heartbeat);
  RUN_TEST(a_node_that_falls_silent_is_said_to_be_so);
  RUN_TEST(latency_is_from_a_setpoint_to_its_answer_over_the_last_second);
  RUN_TEST(a_setpoint_without_an_answer_is_counted_when_the_next_one_comes);
  RUN_TEST(with_a_model_it_says_what_the_springs_give);
  RUN_TEST(the_view_fits_a_terminal_and_what_is_not_known_is_a_dash_or_null);
  return UNITY_END();
}
