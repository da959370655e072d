// A hose along the arm: found where it is, and not where joints rub or a balancer acts.
#include <algorithm>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Finding;
using flexcomp::test::DrivenRobot;
using flexcomp::test::findings_of;
namespace effects = flexcomp::effects;
namespace simulation = flexcomp::simulation;

namespace {

simulation::Machine with_effect(simulation::Machine machine, const char* effect, int joint,
                                const effects::Values& values) {
  effects::find_law(effect, "")->apply(values, joint, &machine);
  return machine;
}

bool is_named(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& each) {
    return each.chosen.hypothesis.effect() == "dress_pack";
  });
}

void a_hose_is_found_where_it_is_held() {
  const DrivenRobot robot;
  const std::vector<Finding> found = findings_of(robot.observed(with_effect(
      robot.machine(), "dress_pack", 4, {900, 30, 0.5, 0.5, 0.3, 0.1, 0.12, 0.05, -0.1})));
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING("dress_pack", found[0].chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL(4, found[0].chosen.hypothesis.joint);
}

void joints_that_rub_are_no_hose() {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  for (int joint = 4; joint <= 6; ++joint) {
    truth = with_effect(std::move(truth), "coulomb_friction", joint, {15});
  }
  TEST_ASSERT_FALSE(is_named(findings_of(robot.observed(truth))));
}

void a_balancer_of_one_joint_is_no_hose() {
  const DrivenRobot robot;
  TEST_ASSERT_FALSE(is_named(findings_of(robot.observed(
      with_effect(robot.machine(), "gravity_compensator", 2, {2000, -900, 0.45, 1.2})))));
}

void a_load_is_no_hose() {
  const DrivenRobot robot;
  effects::Values values(effects::find_law("payload", "")->parameters(robot.robot, 0).size(), 0.0);
  values[0] = 60;  // kg
  TEST_ASSERT_FALSE(
      is_named(findings_of(robot.observed(with_effect(robot.machine(), "payload", 0, values)))));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_hose_is_found_where_it_is_held);
  RUN_TEST(joints_that_rub_are_no_hose);
  RUN_TEST(a_balancer_of_one_joint_is_no_hose);
  RUN_TEST(a_load_is_no_hose);
  return UNITY_END();
}
