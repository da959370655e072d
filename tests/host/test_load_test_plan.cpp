#include <cmath>
#include <random>
#include <string>

#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "model/robot.hpp"
#include "study/load_test_plan.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::study;

namespace {

/// With a tool whose tip lies off the axis of joint 6, so that a force there turns that joint too.
RobotModel<double, 6> some_robot() {
  RobotModel<double, 6> robot =
      model::six_axis_model(model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/kr270/robot.yaml"));
  robot.tool.position = {0.2, 0.1, 0.3};
  return robot;
}

PlanRequest some_request(double precision) {
  PlanRequest request;
  request.precision = precision;
  request.candidates = 100;
  return request;
}

LoadTestPlan plan_of(const RobotModel<double, 6>& robot, const PlanRequest& request) {
  return plan_load_tests(robot, request, [](std::size_t, std::size_t) {});
}

void a_plan_reaches_the_precision() {
  const RobotModel<double, 6> robot = some_robot();
  std::size_t before = 0;
  for (const double precision : {0.5, 0.25}) {
    const PlanRequest request = some_request(precision);
    const LoadTestPlan plan = plan_of(robot, request);
    TEST_ASSERT_TRUE(plan.is_precise);
    TEST_ASSERT_TRUE(plan.half_width.maxCoeff() <= precision);
    TEST_ASSERT_TRUE(plan.tests.size() > before);
    before = plan.tests.size();
  }
}

void a_plan_is_at_least_twice_as_good_as_random_tests() {
  const RobotModel<double, 6> robot = some_robot();
  for (const std::size_t most : {8U, 20U, 40U}) {
    PlanRequest request = some_request(1e-3);
    request.most = most;
    const LoadTestPlan plan = plan_of(robot, request);
    TEST_ASSERT_EQUAL(most, plan.tests.size());
    TEST_ASSERT_TRUE(gain_over_random(robot, plan, request) >= 2);
  }
}

/// The precision that the plan promises is what identification has, over simulated measurements.
void the_promise_is_kept_by_the_identification() {
  const RobotModel<double, 6> robot = some_robot();
  const PlanRequest request = some_request(0.4);
  const LoadTestPlan plan = plan_of(robot, request);
  recording::Recording recording = as_recording(plan);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  constexpr int kRepeats = 300;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(6);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    recording.position = recording::Samples(recording.size(), 3);
    for (Eigen::Index row = 0; row < recording.size(); ++row) {
      const JointVector<double, 6> q = recording.q_cmd->row(row).transpose();
      const Wrench<double> wrench = recording.wrench->row(row).transpose();
      const Vector3<double> place = forward_kinematics<double, 6>(robot, q).tcp.position +
                                    deflection<double, 6>(robot, q, wrench).tcp.head<3>();
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        (*recording.position)(row, axis) = place[axis] + request.noise * normal(random);
      }
    }
    const Identification found = identify_springs(robot, recording, request.sought);
    for (std::size_t i = 0; i < 6; ++i) {
      squares[static_cast<Eigen::Index>(i)] +=
          std::pow(found.springs[i].value / robot.joints[i].compliance - 1, 2);
    }
  }
  const Eigen::VectorXd got = 1.96 * (squares / kRepeats).cwiseSqrt();
  for (Eigen::Index i = 0; i < 6; ++i) {
    // Never worse; better where rows of one posture share their reading without load.
    TEST_ASSERT_TRUE(got[i] < 1.15 * plan.half_width[i]);
    TEST_ASSERT_TRUE(got[i] > 0.6 * plan.half_width[i]);
  }
}

/// The flange lies on the axis of joint 6, or so close to it that no force there turns that joint
/// by more than the noise.
void what_no_test_can_tell_is_said_and_does_not_stop_the_plan() {
  for (const double off_axis : {0.0, 0.24e-3, 5e-3}) {
    RobotModel<double, 6> robot = some_robot();
    robot.tool.position = {0, off_axis, 0};
    const PlanRequest request = some_request(0.5);
    const LoadTestPlan plan = plan_of(robot, request);
    TEST_ASSERT_TRUE(plan.is_precise);
    TEST_ASSERT_TRUE(plan.tests.size() < request.most);
    TEST_ASSERT_TRUE(std::isinf(plan.half_width[5]));
    TEST_ASSERT_TRUE(plan.half_width.head<5>().maxCoeff() <= 0.5);
  }
}

void a_precision_out_of_reach_ends_at_the_most_tests() {
  PlanRequest request = some_request(1e-6);
  request.most = 12;
  const LoadTestPlan plan = plan_of(some_robot(), request);
  TEST_ASSERT_FALSE(plan.is_precise);
  TEST_ASSERT_EQUAL(12, plan.tests.size());
}

void requests_that_make_no_sense_are_refused() {
  int refused = 0;
  for (const auto& spoil :
       {+[](PlanRequest* r) { r->force = 0; }, +[](PlanRequest* r) { r->noise = -1; },
        +[](PlanRequest* r) { r->precision = std::nan(""); }, +[](PlanRequest* r) { r->most = 0; },
        +[](PlanRequest* r) { r->least_height = 100; }}) {
    PlanRequest request = some_request(0.5);
    spoil(&request);
    try {
      plan_of(some_robot(), request);
    } catch (const InputError&) {
      ++refused;
    }
  }
  TEST_ASSERT_EQUAL(5, refused);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_plan_reaches_the_precision);
  RUN_TEST(a_plan_is_at_least_twice_as_good_as_random_tests);
  RUN_TEST(the_promise_is_kept_by_the_identification);
  RUN_TEST(what_no_test_can_tell_is_said_and_does_not_stop_the_plan);
  RUN_TEST(a_precision_out_of_reach_ends_at_the_most_tests);
  RUN_TEST(requests_that_make_no_sense_are_refused);
  return UNITY_END();
}
