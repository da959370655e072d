#include <random>
#include <string>

#include "flexcomp/chain.hpp"
#include "model/robot.hpp"
#include "study/wrist_reach.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr const char* kRobots[] = {"kr100", "kr270", "kr360", "kr500"};

RobotModel<double, 6> robot_named(const std::string& name) {
  return model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml").elastic;
}

void no_pose_that_the_robot_can_take_is_out_of_reach() {
  std::mt19937_64 draw(1);
  for (const char* name : kRobots) {
    const RobotModel<double, 6> robot = robot_named(name);
    const study::WristReach reach(robot, true);
    for (int repeat = 0; repeat < 2000; ++repeat) {
      JointVector<double, 6> q;
      for (std::size_t i = 0; i < 6; ++i) {
        std::uniform_real_distribution<double> angle(robot.joints[i].lower, robot.joints[i].upper);
        q[static_cast<Eigen::Index>(i)] = angle(draw);
      }
      TEST_ASSERT_TRUE(reach.may_hold(forward_kinematics<double, 6>(robot, q).tcp));
    }
  }
}

void the_wrist_counts_and_not_the_tcp() {
  RobotModel<double, 6> robot = robot_named("kr270");
  robot.tool.position = robot.tool.rotation * Vector3<double>(0, 0, 1);
  const study::WristReach reach(robot, true);
  Pose<double> pose;
  pose.rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // the tool points forward
  pose.position = {2.695 + 0.23 + 1 + 0.01, 0, 0.75};
  TEST_ASSERT_FALSE(reach.may_hold(pose));
  pose.position.x() -= 0.02;
  TEST_ASSERT_TRUE(reach.may_hold(pose));
}

void the_middle_that_joint_3_keeps_the_wrist_from_is_out_of_reach_only_with_limits() {
  const RobotModel<double, 6> robot = robot_named("kr270");
  Pose<double> pose;
  pose.rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  pose.position = {0.05 + 0.23, 0, 0.75};  // 0.3 m from the axis of joint 2, 0.4 m backwards
  TEST_ASSERT_FALSE(study::WristReach(robot, true).may_hold(pose));
  TEST_ASSERT_TRUE(study::WristReach(robot, false).may_hold(pose));
}

void of_a_robot_with_another_wrist_nothing_is_known() {
  RobotModel<double, 6> robot = robot_named("kr270");
  robot.joints[5].origin.position.y() += 0.05;
  Pose<double> pose;
  pose.position = {10, 0, 0};
  TEST_ASSERT_TRUE(study::WristReach(robot, true).may_hold(pose));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(no_pose_that_the_robot_can_take_is_out_of_reach);
  RUN_TEST(the_wrist_counts_and_not_the_tcp);
  RUN_TEST(the_middle_that_joint_3_keeps_the_wrist_from_is_out_of_reach_only_with_limits);
  RUN_TEST(of_a_robot_with_another_wrist_nothing_is_known);
  return UNITY_END();
}
