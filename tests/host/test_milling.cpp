// The robot in the cut against the closed form of a linear spring, and the sides of a contour.
#include <cmath>

#include "core/test_robots.hpp"
#include "error.hpp"
#include "flexcomp/compliance.hpp"
#include "host/milled_loop.hpp"
#include "simulation/milling.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::simulation;
using flexcomp::test::kr270;
using flexcomp::test::kTurn;
using flexcomp::test::loop_angles;
using flexcomp::test::loop_path;

namespace {

void the_normal_points_out_of_the_loop_whichever_way_it_runs() {
  const RobotModel<double, 6> model = kr270<double>();
  for (const bool backwards : {false, true}) {
    const Contour contour(model, loop_path(backwards), MaterialSide::outside);
    const Contour inside(model, loop_path(backwards), MaterialSide::inside);
    Vector3<double> center = Vector3<double>::Zero();
    for (int i = 0; i < 100; ++i) {
      center += contour.at(i / 100.0).position / 100;
    }
    for (int i = 5; i < 95; ++i) {
      const Contour::Point point = contour.at(i / 100.0);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, point.normal.norm());
      TEST_ASSERT_TRUE(point.normal.dot(point.position - center) > 0);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1, inside.at(i / 100.0).normal.dot(point.normal));
    }
  }
}

void time_begins_at_the_first_row_and_is_held_at_the_ends() {
  const RobotModel<double, 6> model = kr270<double>();
  const Contour contour(model, loop_path(), MaterialSide::outside);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, contour.duration());
  TEST_ASSERT_TRUE(contour.at(-1).q.isApprox(loop_angles<double>(0), 1e-12));
  TEST_ASSERT_TRUE(contour.at(9).q.isApprox(loop_angles<double>(kTurn), 1e-12));
}

void the_engagement_is_that_of_a_linear_spring() {
  // To first order e = 1 + n·C w e / a, so e = 1 / (1 − n·C w / a).
  const RobotModel<double, 6> model = kr270<double>();
  const Contour contour(model, loop_path(), MaterialSide::outside);
  for (const double depth : {0.01, 0.004}) {
    MillingRobot robot(model::chain_of(model), {depth, MaterialSide::outside});
    for (int i = 0; i < 50; ++i) {
      const Contour::Point point = contour.at(i / 50.0);
      const auto kinematics = forward_kinematics<double, 6>(model, point.q);
      const Twist<double> bent = tcp_compliance<double, 6>(model, kinematics) * point.wrench;
      const double expected = 1 / (1 - point.normal.dot(bent.head<3>()) / depth);
      const MillingRobot::State state = robot.stand(point.q, point, 1);
      TEST_ASSERT_DOUBLE_WITHIN(2e-3 * expected, expected, state.engagement);
      TEST_ASSERT_TRUE(state.wrench.isApprox(state.engagement * point.wrench, 1e-12));
    }
  }
}

void in_the_air_nothing_bends() {
  const RobotModel<double, 6> model = kr270<double>();
  const Contour contour(model, loop_path(), MaterialSide::outside);
  MillingRobot robot(model::chain_of(model), {});
  const Contour::Point point = contour.at(0.3);
  const MillingRobot::State state = robot.stand(point.q, point, 0);
  TEST_ASSERT_TRUE(state.position.isApprox(point.position, 1e-12));
  TEST_ASSERT_EQUAL_DOUBLE(0, state.wrench.norm());
}

void a_tool_that_digs_in_is_stopped() {
  const RobotModel<double, 6> model = kr270<double>();
  const Contour contour(model, loop_path(), MaterialSide::outside);
  double most = 0;
  MillingRobot robot(model::chain_of(model), {1e-5, MaterialSide::outside});
  for (int i = 0; i < 50; ++i) {
    const Contour::Point point = contour.at(i / 50.0);
    most = std::max(most, robot.stand(point.q, point, 1).engagement);
  }
  TEST_ASSERT_EQUAL_DOUBLE(MillingRobot::kMostEngagement, most);
}

void a_path_without_an_area_has_no_sides() {
  const RobotModel<double, 6> model = kr270<double>();
  recording::Recording path = loop_path();
  path.q_cmd->rowwise() = path.q_cmd->row(0).eval();
  try {
    const Contour contour(model, path, MaterialSide::outside);
    TEST_FAIL_MESSAGE("accepted");
  } catch (const InputError& error) {
    TEST_ASSERT_NOT_NULL(std::strstr(error.what(), "no area"));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_normal_points_out_of_the_loop_whichever_way_it_runs);
  RUN_TEST(time_begins_at_the_first_row_and_is_held_at_the_ends);
  RUN_TEST(the_engagement_is_that_of_a_linear_spring);
  RUN_TEST(in_the_air_nothing_bends);
  RUN_TEST(a_tool_that_digs_in_is_stopped);
  RUN_TEST(a_path_without_an_area_has_no_sides);
  return UNITY_END();
}
