#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "error.hpp"
#include "model/robot.hpp"
#include "study/circularity_map.hpp"
#include "study/presets.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kHundredth = 0.02e-3;  // m: to what the published and computed figures are held

model::Robot robot_named(const std::string& name) {
  return model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml");
}

const study::MilledCircle& preset(const std::string& name) { return study::preset(name).circle; }

study::CircularityMap map_of(const std::string& robot, const study::MilledCircle& circle) {
  const study::CircleStudy of(model::six_axis_model(robot_named(robot)), circle);
  return study::map_circularity(of, 0.05, [](std::size_t, std::size_t) {});
}

/// Minimum, maximum and middle, mm, that a prototype of another author computed.
struct Figures {
  const char* robot;
  std::array<double, 3> values;
};

void assert_figures(const study::MilledCircle& circle, const Figures& expected) {
  const study::MapSummary got = study::summarize(map_of(expected.robot, circle));
  TEST_ASSERT_DOUBLE_WITHIN(kHundredth, expected.values[0] * 1e-3, got.min);
  TEST_ASSERT_DOUBLE_WITHIN(kHundredth, expected.values[1] * 1e-3, got.max);
  TEST_ASSERT_DOUBLE_WITHIN(kHundredth, expected.values[2] * 1e-3, got.mean);
}

void strict_preset_gives_the_figures_of_the_prototype() {
  for (const Figures& robot : {Figures{"kr100", {0.49, 3.06, 1.52}},
                               {"kr270", {0.51, 2.84, 1.45}},
                               {"kr360", {0.82, 2.68, 1.62}},
                               {"kr500", {0.15, 1.28, 0.66}}}) {
    assert_figures(preset("strict"), robot);
  }
}

void strict_preset_to_first_order_gives_the_figures_of_the_prototype() {
  study::MilledCircle circle = preset("strict");
  circle.is_first_order = true;
  for (const Figures& robot : {Figures{"kr100", {0.42, 3.29, 1.55}},
                               {"kr270", {0.45, 3.04, 1.48}},
                               {"kr360", {0.77, 2.79, 1.63}},
                               {"kr500", {0.12, 1.38, 0.68}}}) {
    assert_figures(circle, robot);
  }
}

void flange_preset_gives_the_figures_of_the_prototype() {
  for (const Figures& robot : {Figures{"kr100", {0.93, 3.15, 1.77}},
                               {"kr270", {0.94, 2.97, 1.71}},
                               {"kr360", {1.13, 2.76, 1.84}},
                               {"kr500", {0.39, 1.42, 0.83}}}) {
    assert_figures(preset("flange"), robot);
  }
}

void counter_preset_gives_the_figures_of_the_prototype() {
  const study::MilledCircle& circle = preset("counter");
  for (const Figures& robot : {Figures{"kr100", {0.93, 3.29, 1.85}},
                               {"kr270", {0.83, 3.04, 1.69}},
                               {"kr360", {1.02, 2.79, 1.74}},
                               {"kr500", {0.39, 1.38, 0.80}}}) {
    const study::MapSummary got = study::summarize(map_of(robot.robot, circle));
    TEST_ASSERT_DOUBLE_WITHIN(kHundredth, robot.values[0] * 1e-3, got.min);
    TEST_ASSERT_DOUBLE_WITHIN(kHundredth, robot.values[1] * 1e-3, got.max);
    const study::CircleStudy of(model::six_axis_model(robot_named(robot.robot)), circle);
    TEST_ASSERT_DOUBLE_WITHIN(kHundredth, robot.values[2] * 1e-3,
                              study::counter_middle(of.arm(), circle));
  }
}

void best_squares_give_the_figures_of_the_prototype() {
  const std::array<double, 3> sizes = {0.1, 0.2, 0.5};
  for (const Figures& robot : {Figures{"kr100", {0.50, 0.52, 0.66}},
                               {"kr270", {0.52, 0.53, 0.62}},
                               {"kr360", {0.82, 0.83, 0.95}},
                               {"kr500", {0.15, 0.17, 0.33}}}) {
    const study::CircularityMap map = map_of(robot.robot, preset("strict"));
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const study::BestSquare best = study::best_square(map, sizes[i]);
      TEST_ASSERT_TRUE(best.fits);
      TEST_ASSERT_DOUBLE_WITHIN(kHundredth, robot.values[i] * 1e-3, best.worst);
    }
  }
}

/// |F| |Σ k a²|: the Jacobian frozen at the centre, the wrench with the path.
void first_order_agrees_with_the_closed_form() {
  study::MilledCircle circle = preset("strict");
  circle.is_first_order = true;
  circle.points = 720;
  circle.radius = 1;  // so that the deflection is small beside it
  const study::CircleStudy of(model::six_axis_model(robot_named("kr360")), circle);
  const study::PlanarArm& arm = of.arm();
  const study::Planar center(1.9, 1.4);
  const study::Planar reach = center - arm.shoulder;
  const double distance = std::abs(reach);
  const double upper = std::abs(arm.upper_arm);
  const double side = std::acos((upper * upper + distance * distance - std::norm(arm.forearm)) /
                                (2 * upper * distance));
  const study::Planar fore = reach - std::polar(upper, std::arg(reach) + side);
  const double expected = std::hypot(440, 1370) * std::abs(arm.compliance[0] * reach * reach +
                                                           arm.compliance[1] * fore * fore);
  TEST_ASSERT_DOUBLE_WITHIN(1e-3 * expected, expected, of.circularity(center));
}

void the_core_gives_the_same_where_a_spring_needs_it() {
  model::Robot robot = robot_named("kr270");
  for (const study::ToolPoint point : {study::ToolPoint::wrist, study::ToolPoint::tcp}) {
    study::MilledCircle circle;
    circle.point = point;
    const double planar =
        study::CircleStudy(model::six_axis_model(robot), circle).circularity({1.7, 1.2});
    RobotModel<double, 6> other = model::six_axis_model(robot);
    other.base_compliance[3] = 1e-30;  // a spring, but a stiff one: the core computes
    const double full = study::CircleStudy(other, circle).circularity({1.7, 1.2});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, planar, full);
    other.base_compliance[4] = 1e-6;
    TEST_ASSERT_TRUE(study::CircleStudy(other, circle).circularity({1.7, 1.2}) > 1.1 * planar);
  }
}

void a_circle_is_in_reach_only_if_all_of_it_is() {
  study::MilledCircle circle;
  circle.has_limits = false;
  const study::CircleStudy of(model::six_axis_model(robot_named("kr270")), circle);
  const study::PlanarArm& arm = of.arm();
  const double edge = arm.shoulder.real() + arm.reach[1];
  TEST_ASSERT_FALSE(std::isnan(of.circularity({edge - 0.11, arm.shoulder.imag()})));
  TEST_ASSERT_TRUE(std::isnan(of.circularity({edge - 0.09, arm.shoulder.imag()})));
}

void joint_limits_take_places_away() {
  study::MilledCircle circle;
  const std::size_t within = study::summarize(map_of("kr500", circle)).reached;
  circle.has_limits = false;
  TEST_ASSERT_TRUE(study::summarize(map_of("kr500", circle)).reached > within);
}

void a_square_too_large_for_the_reach_has_no_place() {
  const study::CircularityMap map = map_of("kr500", preset("strict"));
  TEST_ASSERT_FALSE(study::best_square(map, 3).fits);
  TEST_ASSERT_FALSE(study::best_square(map, 100).fits);
}

void a_robot_that_is_not_planar_is_refused() {
  RobotModel<double, 6> model = model::six_axis_model(robot_named("kr270"));
  model.joints[1].axis = {0, std::cos(0.1), std::sin(0.1)};
  try {
    study::CircleStudy(model, {});
    TEST_FAIL_MESSAGE("accepted");
  } catch (const InputError& error) {
    TEST_ASSERT_NOT_NULL(std::strstr(error.what(), "here joint 2's is not"));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(strict_preset_gives_the_figures_of_the_prototype);
  RUN_TEST(strict_preset_to_first_order_gives_the_figures_of_the_prototype);
  RUN_TEST(flange_preset_gives_the_figures_of_the_prototype);
  RUN_TEST(counter_preset_gives_the_figures_of_the_prototype);
  RUN_TEST(best_squares_give_the_figures_of_the_prototype);
  RUN_TEST(first_order_agrees_with_the_closed_form);
  RUN_TEST(the_core_gives_the_same_where_a_spring_needs_it);
  RUN_TEST(a_circle_is_in_reach_only_if_all_of_it_is);
  RUN_TEST(joint_limits_take_places_away);
  RUN_TEST(a_square_too_large_for_the_reach_has_no_place);
  RUN_TEST(a_robot_that_is_not_planar_is_refused);
  return UNITY_END();
}
