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
  return model::six_axis_model(
      model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml"));
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
      TEST_ASSERT_TRUE(all && all->is_exact);
      TEST_ASSERT_TRUE(!all->solutions.empty() && all->solutions.size() <= 8);
      for (const Angles& q : all->solutions) {
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

/// As in models measured from drawings: joint 1 beside the base frame's origin, the wrist beside
/// the plane of the arm, the base turned, zeros elsewhere.
RobotModel<double, 6> crooked_robot() {
  RobotModel<double, 6> robot = robot_named("kr270");
  robot.joints[0].origin.position = {-2.62e-3, 0.98e-3, 0.331};
  robot.joints[1].origin.position.y() = -0.037;
  robot.joints[3].origin.position.y() = 0.012;
  robot.joints[0].origin.rotation =
      Eigen::AngleAxisd(0.4, Vector3<double>(0.36, 0.48, 0.8)).toRotationMatrix();
  robot.joints[4].origin.rotation =
      Eigen::AngleAxisd(0.7, Vector3<double>::UnitY()).toRotationMatrix();
  robot.joints[2].axis *= -1;
  robot.tool.position = {0.1, -0.05, 0.4};
  return robot;
}

/// By Denavit–Hartenberg parameters as published for the UR10: six joints of ±2π, joints 2 to 4
/// parallel.
RobotModel<double, 6> parallel_robot() {
  constexpr double kA[] = {0, -0.612, -0.5723, 0, 0, 0};
  constexpr double kD[] = {0.1273, 0, 0, 0.163941, 0.1157, 0.0922};
  constexpr double kAlpha[] = {M_PI / 2, 0, 0, M_PI / 2, -M_PI / 2, 0};
  RobotModel<double, 6> robot;
  Pose<double> after;  // of the joint before: what stands between its axis and the next
  for (std::size_t i = 0; i < 6; ++i) {
    robot.joints[i].origin = after;
    robot.joints[i].axis = Vector3<double>::UnitZ();
    robot.joints[i].lower = -2 * M_PI;
    robot.joints[i].upper = 2 * M_PI;
    robot.joints[i].compliance = 1e-5;
    after.position = {kA[i], 0, kD[i]};
    after.rotation = Eigen::AngleAxisd(kAlpha[i], Vector3<double>::UnitX()).toRotationMatrix();
  }
  robot.tool = after;
  return robot;
}

void robots_of_the_kind_are_solved_wherever_their_axes_are() {
  std::mt19937_64 draw(7);
  for (const RobotModel<double, 6>& robot : {crooked_robot(), parallel_robot()}) {
    for (int repeat = 0; repeat < 250; ++repeat) {
      const Angles q = some_angles(robot, &draw);
      const Pose<double> target = pose_at(robot, q);
      const auto all = planning::solve_closed_form(robot, target);
      TEST_ASSERT_TRUE(all && all->is_exact && all->solutions.size() <= 8);
      TEST_ASSERT_TRUE(is_among(q, all->solutions));
      for (const Angles& solution : all->solutions) {
        TEST_ASSERT_TRUE(distance(target, pose_at(robot, solution)) < 1e-9);
      }
    }
  }
}

/// A calibrated robot: every axis a little beside where it was drawn.
void a_robot_nearly_of_the_kind_is_solved_to_the_last_digits() {
  std::mt19937_64 draw(8);
  std::uniform_real_distribution<double> off(-1e-4, 1e-4);
  for (RobotModel<double, 6> robot : {crooked_robot(), parallel_robot()}) {
    for (Joint<double>& joint : robot.joints) {
      joint.origin.position += Vector3<double>(off(draw), off(draw), off(draw));
      joint.axis = (joint.axis + Vector3<double>(off(draw), off(draw), off(draw))).normalized();
    }
    int found = 0;
    constexpr int kRepeats = 200;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const Angles q = some_angles(robot, &draw);
      const Pose<double> target = pose_at(robot, q);
      const auto closed = planning::solve_closed_form(robot, target);
      TEST_ASSERT_TRUE(closed && !closed->is_exact);
      const std::vector<Angles> all = planning::solve_all(robot, target);
      found += is_among(q, all) ? 1 : 0;
    }
    // Beside a singularity Newton's method may go elsewhere.
    TEST_ASSERT_TRUE(found > 0.95 * kRepeats);
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
  std::mt19937_64 draw(4);
  for (const RobotModel<double, 6>& robot :
       {robot_named("kr500"), crooked_robot(), parallel_robot()}) {
    for (int repeat = 0; repeat < 10; ++repeat) {
      const Pose<double> target = pose_at(robot, some_angles(robot, &draw));
      const std::vector<Angles> all = planning::solve_all(robot, target);
      for (const Angles& q : planning::search_all(robot, target)) {
        TEST_ASSERT_TRUE(is_among(q, all));
      }
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
  RUN_TEST(robots_of_the_kind_are_solved_wherever_their_axes_are);
  RUN_TEST(a_robot_nearly_of_the_kind_is_solved_to_the_last_digits);
  RUN_TEST(a_straight_wrist_is_solved_too);
  RUN_TEST(a_pose_out_of_reach_has_no_solution);
  RUN_TEST(a_robot_with_another_wrist_is_searched_instead);
  RUN_TEST(every_solution_is_given_once);
  RUN_TEST(the_search_finds_no_more);
  RUN_TEST(near_a_posture_the_solution_of_that_branch_is_found);
  return UNITY_END();
}
