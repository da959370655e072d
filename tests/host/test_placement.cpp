#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "model/robot.hpp"
#include "planning/circle.hpp"
#include "study/placement.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::study;

namespace {

RobotModel<double, 6> some_robot() {
  return model::six_axis_model(
      model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/kr270/robot.yaml"));
}

/// A circle far out, where the robot is soft.
recording::Recording job_of(const RobotModel<double, 6>& robot) {
  planning::CirclePlan plan;
  plan.center = {2.1, 0, 1.4};
  plan.first_axis = Vector3<double>::UnitX();
  plan.second_axis = Vector3<double>::UnitZ();
  plan.tool_axis = Vector3<double>::UnitY();
  plan.points = 72;
  plan.force = {440, 1370, 635};
  plan.moment = {0, 3, 10.5};
  return planning::plan_circle(robot, plan, [](int) {});
}

PlacementRequest some_request() {
  PlacementRequest request;
  request.points = 12;
  request.evaluations = 300;
  return request;
}

PlacedJob placed(const recording::Recording& job, const PlacementRequest& request) {
  return best_placement(some_robot(), job, request, [](int) {});
}

void a_better_place_is_found_within_the_bounds() {
  const recording::Recording job = job_of(some_robot());
  const PlacementRequest request = some_request();
  const PlacedJob before = as_placed(some_robot(), job);
  const PlacedJob after = placed(job, request);
  TEST_ASSERT_TRUE(after.largest < 0.8 * before.largest);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    TEST_ASSERT_TRUE(std::abs(after.placement.shift[axis]) <= request.most_shift[axis]);
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0, after.placement.turn);
}

/// The new path is the old one moved: same distances, orientation but for the spin.
void the_job_keeps_its_form() {
  const RobotModel<double, 6> robot = some_robot();
  const recording::Recording job = job_of(robot);
  PlacementRequest request = some_request();
  request.most_turn = 0.5;
  const PlacedJob after = placed(job, request);
  const auto place = [&](const recording::Recording& path, Eigen::Index row) {
    return forward_kinematics<double, 6>(robot, path.q_cmd->row(row).transpose()).tcp;
  };
  const Matrix3<double> turn =
      Eigen::AngleAxisd(after.placement.turn, Vector3<double>::UnitZ()).toRotationMatrix();
  for (Eigen::Index row = 0; row < job.size(); row += 7) {
    const Vector3<double> was = place(job, row).position - place(job, 0).position;
    const Vector3<double> is = place(after.path, row).position - place(after.path, 0).position;
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0, (turn * was - is).norm());
    const Vector3<double> axis_was = turn * place(job, row).rotation.col(2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0, (axis_was - place(after.path, row).rotation.col(2)).norm());
    const Vector3<double> force = turn * job.wrench->row(row).head<3>().transpose();
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0,
                              (force - after.path.wrench->row(row).head<3>().transpose()).norm());
  }
}

void the_joints_stay_within_their_limits_and_go_smoothly() {
  const RobotModel<double, 6> robot = some_robot();
  const PlacedJob after = placed(job_of(robot), some_request());
  for (Eigen::Index row = 0; row < after.path.size(); ++row) {
    for (std::size_t joint = 0; joint < 6; ++joint) {
      const double angle = (*after.path.q_cmd)(row, static_cast<Eigen::Index>(joint));
      TEST_ASSERT_TRUE(angle >= robot.joints[joint].lower && angle <= robot.joints[joint].upper);
      if (row > 0) {
        TEST_ASSERT_DOUBLE_WITHIN(
            0.5, (*after.path.q_cmd)(row - 1, static_cast<Eigen::Index>(joint)), angle);
      }
    }
  }
}

/// With a wrench that pulls at one point alone the displacement is known there.
void what_is_told_is_what_the_core_predicts() {
  const RobotModel<double, 6> robot = some_robot();
  recording::Recording job = job_of(robot);
  job.wrench->setZero();
  (*job.wrench)(10, 0) = 1000;
  const PlacedJob as_is = as_placed(robot, job);
  const double expected =
      deflection<double, 6>(robot, job.q_cmd->row(10).transpose(), job.wrench->row(10).transpose())
          .tcp.head<3>()
          .norm();
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected, as_is.largest);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected / std::sqrt(static_cast<double>(job.size())),
                            as_is.mean_square);
}

/// Two points say little of what lies between; more are looked at until the place can be followed.
void a_place_that_cannot_be_followed_is_sought_with_more_points() {
  PlacementRequest request = some_request();
  request.points = 2;
  const PlacedJob after = placed(job_of(some_robot()), request);
  TEST_ASSERT_TRUE(after.largest < as_placed(some_robot(), job_of(some_robot())).largest);
}

void jobs_and_requests_that_make_no_sense_are_refused() {
  const RobotModel<double, 6> robot = some_robot();
  int refused = 0;
  const auto attempt = [&](const recording::Recording& job, const PlacementRequest& request) {
    try {
      placed(job, request);
    } catch (const InputError&) {
      ++refused;
    }
  };
  PlacementRequest request = some_request();
  request.most_shift[0] = -1;
  attempt(job_of(robot), request);
  recording::Recording lacking = job_of(robot);
  lacking.wrench.reset();
  attempt(lacking, some_request());
  request = some_request();
  request.least_singular_value = 100;
  request.evaluations = 20;
  attempt(job_of(robot), request);
  TEST_ASSERT_EQUAL(3, refused);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_better_place_is_found_within_the_bounds);
  RUN_TEST(the_job_keeps_its_form);
  RUN_TEST(the_joints_stay_within_their_limits_and_go_smoothly);
  RUN_TEST(what_is_told_is_what_the_core_predicts);
  RUN_TEST(a_place_that_cannot_be_followed_is_sought_with_more_points);
  RUN_TEST(jobs_and_requests_that_make_no_sense_are_refused);
  return UNITY_END();
}
