// What happened once: found with its time and place, left out, and not where it comes again.
#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/event.hpp"
#include "diagnosis/output/sentences.hpp"
#include "unity_main.hpp"

using namespace flexcomp::diagnosis;
using flexcomp::test::diagnosed;
using flexcomp::test::DrivenRobot;
namespace effects = flexcomp::effects;

namespace {

constexpr double kBegin = 20.5;   // s
constexpr double kLong = 0.3;     // s
constexpr double kFriction = 40;  // N·m
const double kBump = 60 * DrivenRobot::kNoise;

/// A robot that is pushed at its third joint, every so many seconds.
Observations pushed(double every, bool rubs) {
  const DrivenRobot robot;
  flexcomp::simulation::Machine truth = robot.machine();
  if (rubs) {
    effects::find_law("coulomb_friction", "")->apply({kFriction}, 2, &truth);
  }
  const auto push = [=](double time) {
    return std::fmod(time - kBegin + 10 * every, every) < kLong ? kBump : 0;
  };
  flexcomp::test::add_torque(3, push, &truth);
  return robot.observed(truth);
}

void a_bump_is_told_with_its_time_and_joint() {
  Observations observations = pushed(100, false);
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_TRUE(found.choice.findings.empty());
  TEST_ASSERT_EQUAL_UINT64(1, found.events.size());
  const Event& event = found.events.front();
  TEST_ASSERT_DOUBLE_WITHIN(0.15, kBegin, event.begin);
  TEST_ASSERT_DOUBLE_WITHIN(0.15, kBegin + kLong, event.end);
  TEST_ASSERT_EQUAL_UINT64(1, event.excursions.size());
  TEST_ASSERT_EQUAL_INT64(2, event.excursions.front().component);
  TEST_ASSERT_DOUBLE_WITHIN(3 * DrivenRobot::kNoise, kBump, event.excursions.front().most);
  TEST_ASSERT_EQUAL_STRING(
      "Model and recording agree within the noise, but for what happened once.",
      headline(observations, found).c_str());
  const std::string statement = statement_of_event(observations, event);
  TEST_ASSERT_EQUAL_UINT64(0, statement.find("Something happened once, from 20."));
  TEST_ASSERT_TRUE(statement.find("of swinging.csv: joint torque of joint 3 is off by up to 12") !=
                   std::string::npos);
}

void an_effect_beside_a_bump_is_found() {
  Observations observations = pushed(100, true);
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_UINT64(1, found.events.size());
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  const Chosen& chosen = found.choice.findings.front().chosen;
  TEST_ASSERT_EQUAL_STRING("coulomb_friction", chosen.hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kFriction, kFriction, chosen.values.front());
}

void what_comes_again_and_again_is_no_event() {
  Observations observations = pushed(3, false);
  TEST_ASSERT_TRUE(diagnosed(&observations, 0).events.empty());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_bump_is_told_with_its_time_and_joint);
  RUN_TEST(an_effect_beside_a_bump_is_found);
  RUN_TEST(what_comes_again_and_again_is_no_event);
  return UNITY_END();
}
