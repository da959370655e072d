#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "flexcomp/chain.hpp"
#include "flexcomp/compliance.hpp"
#include "model/robot.hpp"
#include "planning/closed_form.hpp"
#include "planning/inverse_kinematics.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using planning::Angles;

namespace {

constexpr const char* kRobots[] = {"kr100", "kr270", "kr360", "kr500"};

RobotModel<double, 6> robot_named(const std::string& name) {
  return model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml").elastic;
}

Angles some_angles(const RobotModel<double, 6>& robot, std::mt19937_64* draw) {
  Angles q;
  for (std::size_t i = 0; i < 6; ++i) {
    std::uniform_real_distribution<double> angle(robot.joints[i].lower, robot.joints[i].upper);
    q[static_cast<Eigen::Index>(i)] = angle(*draw);
  }
  return q;
}

Pose<double> pose_at(const RobotModel<double, 6>& robot, const Angles& q) {
  return forward_kinematics<double, 6>(robot, q).tcp;
}

double distance(const Pose<double>& a, const Pose<double>& b) {
  return pose_difference(a, b).cwiseAbs().maxCoeff();
}

bool is_same_but_for_turns(const Angles& a, const Angles& b) {
  return ((a - b) / 2).array().sin().abs().maxCoeff() < 1e-6;
}

bool is_among(const Angles& q, const std::vector<Angles>& all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const Angles& other) { return is_same_but_for_turns(q, other); });
}

void every_solution_in_closed_form_reaches_the_pose() {
  std::mt19937_64 draw(1);
  for (const char* name : kRobots) {
    const RobotModel<double, 6> robot = robot_named(name);
    for (int repeat = 0; repeat < 250; ++repeat) {
      const Pose<double> target = pose_at(robot, some_angles(robot, &draw));
      const auto all = planning::solve_closed_form(robot, target);
      TEST_ASSERT_TRUE(all && !all->empty() && all->size() <= 8);
      for (const Angles& q : *all) {
        TEST_ASSERT_TRUE(distance(target, pose_at(robot, q)) < 1e-9);
      }
    }
  }
}

void the_angles_that_a_pose_was_made_of_are_among_the_solutions() {
  std::mt19937_64 draw(2);
  for (const char* name : kRobots) {
    RobotModel<double, 6> robot = robot_named(name);
    robot.tool.position = {0.1, -0.05, 0.4};
    robot.tool.rotation =
        robot.tool.rotation * Matrix3<double>(Eigen::AngleAxisd(0.3, Vector3<double>(0.6, 0, 0.8)));
    for (int repeat = 0; repeat < 250; ++repeat) {
      const Angles q = some_angles(robot, &draw);
      TEST_ASSERT_TRUE(is_among(q, planning::solve_all(robot, pose_at(robot, q))));
    }
  }
}

void a_straight_wrist_is_solved_too() {
  const RobotModel<double, 6> robot = robot_named("kr270");
  Angles q;
  q << 0.3, -1.2, 1.4, 0.5, 0, 0.2;
  const Pose<double> target = pose_at(robot, q);
  const std::vector<Angles> all = planning::solve_all(robot, target);
  TEST_ASSERT_FALSE(all.empty());
  TEST_ASSERT_TRUE(distance(target, pose_at(robot, all.front())) < 1e-9);
}

void a_pose_out_of_reach_has_no_solution() {
  const RobotModel<double, 6> robot = robot_named("kr270");
  Pose<double> far;
  far.position = {4, 0, 1};
  TEST_ASSERT_TRUE(planning::solve_all(robot, far).empty());
}

void a_robot_with_another_wrist_is_searched_instead() {
  RobotModel<double, 6> robot = robot_named("kr270");
  robot.joints[5].origin.position.y() += 0.05;
  std::mt19937_64 draw(3);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Angles q = some_angles(robot, &draw);
    const Pose<double> target = pose_at(robot, q);
    TEST_ASSERT_FALSE(planning::solve_closed_form(robot, target).has_value());
    const std::vector<Angles> all = planning::solve_all(robot, target);
    TEST_ASSERT_TRUE(is_among(q, all));
    TEST_ASSERT_TRUE(distance(target, pose_at(robot, all.back())) < 1e-9);
  }
}

void every_solution_is_given_once() {
  const RobotModel<double, 6> robot = robot_named("kr270");
  RobotModel<double, 6> searched = robot;
  searched.joints[5].origin.position.y() += 0.05;
  std::mt19937_64 draw(6);
  for (int repeat = 0; repeat < 20; ++repeat) {
    for (const RobotModel<double, 6>& each : {robot, searched}) {
      std::vector<Angles> seen;
      for (const Angles& q : planning::solve_all(each, pose_at(each, some_angles(each, &draw)))) {
        TEST_ASSERT_FALSE(is_among(q, seen));
        seen.push_back(q);
      }
    }
  }
}

/// Another method: the search from many starts finds nothing that the closed form has not.
void the_search_finds_no_more() {
  RobotModel<double, 6> robot = robot_named("kr500");
  RobotModel<double, 6> searched = robot;
  searched.joints[5].origin.position.y() += 2e-9;  // no closed form, but the same to 1e-8
  std::mt19937_64 draw(4);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Pose<double> target = pose_at(robot, some_angles(robot, &draw));
    const std::vector<Angles> all = planning::solve_all(robot, target);
    for (const Angles& q : planning::solve_all(searched, target)) {
      TEST_ASSERT_TRUE(is_among(q, all));
    }
  }
}

void near_a_posture_the_solution_of_that_branch_is_found() {
  const RobotModel<double, 6> robot = robot_named("kr270");
  std::mt19937_64 draw(5);
  std::uniform_real_distribution<double> near(-0.02, 0.02);
  Angles q;
  q << 0.3, -1.2, 1.4, 0.5, 0.9, 0.2;
  for (int repeat = 0; repeat < 100; ++repeat) {
    Angles moved = q;
    for (Eigen::Index i = 0; i < 6; ++i) {
      moved[i] += near(draw);
    }
    const auto found = planning::solve_near(robot, pose_at(robot, moved), q);
    TEST_ASSERT_TRUE(found && (*found - moved).cwiseAbs().maxCoeff() < 1e-8);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(every_solution_in_closed_form_reaches_the_pose);
  RUN_TEST(the_angles_that_a_pose_was_made_of_are_among_the_solutions);
  RUN_TEST(a_straight_wrist_is_solved_too);
  RUN_TEST(a_pose_out_of_reach_has_no_solution);
  RUN_TEST(a_robot_with_another_wrist_is_searched_instead);
  RUN_TEST(every_solution_is_given_once);
  RUN_TEST(the_search_finds_no_more);
  RUN_TEST(near_a_posture_the_solution_of_that_branch_is_found);
  return UNITY_END();
}
