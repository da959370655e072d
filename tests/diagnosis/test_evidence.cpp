// The evidence for a hypothesis: where it shows, and what it accounts for there.
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/evidence.hpp"
#include "unity_main.hpp"

using namespace flexcomp::diagnosis;
using flexcomp::test::DrivenRobot;
namespace effects = flexcomp::effects;
namespace simulation = flexcomp::simulation;

namespace {

constexpr double kDelay = 0.03;  // s
constexpr Eigen::Index kWorst = 1;

/// All torques come late, and that of joint 2, which it changes most, is wrong besides.
Observations late_torques(const DrivenRobot& robot) {
  simulation::Machine truth = robot.machine();
  const auto wrong = [](double time) { return 600 * std::sin(9 * time); };
  flexcomp::test::add_torque(kWorst + 1, wrong, &truth);
  effects::find_law("time_offset", "joint_torque")->apply({kDelay}, 0, &truth);
  return robot.observed(truth);
}

Chosen late_clock(const Observations& observations) {
  for (const Hypothesis& each : all_hypotheses(observations)) {
    if (each.effect() == "time_offset" && each.law->form == "joint_torque") {
      return {each, {kDelay}};
    }
  }
  TEST_FAIL_MESSAGE("no such hypothesis");
  return {all_hypotheses(observations).front(), {}};
}

void an_effect_is_judged_where_it_stands_out_of_what_is_left() {
  const DrivenRobot robot;
  const Observations observations = late_torques(robot);
  const Fit without = fit(observations, {}, 0);
  const Evidence evidence =
      weigh(observations, without, fit(observations, {late_clock(observations)}, 0), 1);
  TEST_ASSERT_EQUAL_INT(simulation::joint_torque, evidence.group.first);
  TEST_ASSERT_TRUE(evidence.group.second != kWorst);
  TEST_ASSERT_TRUE(evidence.explained > 0.95);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_effect_is_judged_where_it_stands_out_of_what_is_left);
  return UNITY_END();
}
