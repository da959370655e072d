// A pull at the tool that no sensor shows, against the same force as a recording's wrench.
#include "effects/learned.hpp"
#include "effects/moving_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using simulation::Channel;

namespace {

const Vector3<double> kPlace(0.4, -0.9, 3.1);  // m
constexpr double kRest = 0.8;                  // m
constexpr double kStiffness = 300;             // N/m

/// The robot, whose wrench at every row holds what a spring from kPlace pulls.
test::MovingRobot pulled(const test::MovingRobot& free) {
  test::MovingRobot robot = free;
  const Eigen::MatrixXd at =
      predict(effects::machine_of(free.robot), {free.scene()}).front().channel[0];
  for (Eigen::Index row = 0; row < at.rows(); ++row) {
    const Vector3<double> spring = kPlace - at.row(row).transpose();
    robot.recording.wrench->row(row).head<3>() +=
        kStiffness * (spring.norm() - kRest) * spring.normalized().transpose();
  }
  return robot;
}

void a_pull_shows_in_every_channel_as_the_same_force_on_the_tool_does() {
  const test::MovingRobot free;
  const simulation::Machine plain = effects::machine_of(free.robot);
  simulation::Machine machine = plain;
  effects::find_law("tool_pull", "")
      ->apply({-kStiffness * kRest, kStiffness, kPlace.x(), kPlace.y(), kPlace.z()}, 0, &machine);
  const simulation::Prediction before = predict(plain, {free.scene()}).front();
  const simulation::Prediction found = predict(machine, {free.scene()}).front();
  const simulation::Prediction expected = predict(plain, {pulled(free).scene()}).front();
  for (const Channel channel :
       {simulation::tcp_position, simulation::joint_torque, simulation::joint_deflection}) {
    const Eigen::MatrixXd change = expected.channel[channel] - before.channel[channel];
    TEST_ASSERT_TRUE(change.norm() > 0);
    TEST_ASSERT_DOUBLE_WITHIN(
        0.01, 0, (found.channel[channel] - expected.channel[channel]).norm() / change.norm());
  }
}

void a_torque_is_enough_to_see_it() {
  test::MovingRobot free;
  free.recording.wrench.reset();
  free.recording.position.reset();
  free.recording.q_link.reset();
  const simulation::Machine plain = effects::machine_of(free.robot);
  simulation::Machine machine = plain;
  effects::find_law("tool_pull", "")->apply({100, 0, 0, 0, 3}, 0, &machine);
  TEST_ASSERT_TRUE(test::difference(plain, machine, free.scene()) > 1e-3);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_pull_shows_in_every_channel_as_the_same_force_on_the_tool_does);
  RUN_TEST(a_torque_is_enough_to_see_it);
  return UNITY_END();
}
