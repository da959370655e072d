// Whether what is left is noise: of a load test, if it is not alike at poses near each other; of a
// motion, if no component keeps more.
#include <random>

#include "diagnosis/neighbours.hpp"
#include "diagnosis/observations.hpp"
#include "diagnosis/rest.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "effects/learned.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::likeness_of_neighbours;
using diagnosis::Observations;

namespace {

constexpr double kChance = 3;  // standard deviations

/// So many poses of a KR 270, of random angles of all joints, its TCP measured.
Observations load_test(Eigen::Index poses) {
  recording::Recording recording;
  recording.file = "poses.csv";
  recording.time = Eigen::VectorXd::LinSpaced(poses, 0, static_cast<double>(poses - 1));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-0.4, 0.4);
  recording.q_meas = recording::Samples::NullaryExpr(poses, 6, [&] { return angle(random); });
  recording.position = recording::Samples::Zero(poses, 3);
  simulation::Preparation preparation;
  std::vector<simulation::Scene> scenes = {simulation::prepare(recording, poses, &preparation)};
  const model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml");
  simulation::Machine machine = effects::machine_of(robot, scenes);
  return Observations(std::move(machine), std::move(scenes), 0);
}

const Observations& observed() {
  static const Observations observations = load_test(200);
  return observations;
}

/// Noise, and `share` times a bend of the arm that goes with the angle of joint 2.
Eigen::VectorXd remainder(const Observations& observations, unsigned seed, double share) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd values(observations.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const diagnosis::Sample& at = observations.samples[static_cast<std::size_t>(i)];
    values[i] = normal(random) + share * std::sin(6 * observations.scenes[0].q(at.row, 1));
  }
  return values;
}

void noise_is_not_alike_at_neighbours() {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    TEST_ASSERT_DOUBLE_WITHIN(kChance, 0,
                              likeness_of_neighbours(observed(), remainder(observed(), seed, 0)));
  }
}

void what_goes_with_an_angle_is_alike_at_neighbours_though_it_is_smaller_than_noise() {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    TEST_ASSERT_TRUE(likeness_of_neighbours(observed(), remainder(observed(), seed, 0.8)) >
                     kChance);
  }
}

void a_constant_is_no_likeness() {
  const Eigen::VectorXd noise = remainder(observed(), 1, 0);
  const Eigen::VectorXd shifted = noise.array() + 10;
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, likeness_of_neighbours(observed(), noise),
                            likeness_of_neighbours(observed(), shifted));
}

void a_few_poses_tell_nothing() {
  const Observations few = load_test(19);
  TEST_ASSERT_EQUAL_DOUBLE(0, likeness_of_neighbours(few, remainder(few, 1, 5)));
}

void a_rest_within_the_noise_is_noise_unless_it_is_alike_at_neighbours() {
  Observations observations = observed();
  TEST_ASSERT_EQUAL_STRING("",
                           more_than_noise(observations, remainder(observations, 1, 0.8)).c_str());
  observations.noise_is_known = true;
  TEST_ASSERT_EQUAL_STRING("",
                           more_than_noise(observations, remainder(observations, 1, 0)).c_str());
  const Eigen::VectorXd within = 0.7 * remainder(observations, 1, 0.8);
  TEST_ASSERT_EQUAL_STRING("what is left is alike at neighbouring poses, as noise is not",
                           more_than_noise(observations, within).c_str());
  TEST_ASSERT_EQUAL_STRING(
      "3.0 times the noise is left",
      more_than_noise(observations, Eigen::VectorXd::Constant(observations.size(), 3)).c_str());
}

void what_one_axis_keeps_in_what_was_held_out_is_not_hidden_by_the_others() {
  const Observations observations = flexcomp::test::SwingingRobot(1).observed();
  const auto with_along_z = [&](double held_out) {
    Eigen::VectorXd remainder = Eigen::VectorXd::Ones(observations.size());
    for (Eigen::Index i = observations.train; i < observations.size(); ++i) {
      const bool is_z = observations.samples[static_cast<std::size_t>(i)].component == 2;
      remainder[i] = is_z ? held_out : 1;
    }
    return more_than_noise(observations, remainder);
  };
  TEST_ASSERT_EQUAL_STRING("", with_along_z(1.5).c_str());
  TEST_ASSERT_EQUAL_STRING("2.0 times the noise is left along z", with_along_z(2).c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(noise_is_not_alike_at_neighbours);
  RUN_TEST(what_goes_with_an_angle_is_alike_at_neighbours_though_it_is_smaller_than_noise);
  RUN_TEST(a_constant_is_no_likeness);
  RUN_TEST(a_few_poses_tell_nothing);
  RUN_TEST(a_rest_within_the_noise_is_noise_unless_it_is_alike_at_neighbours);
  RUN_TEST(what_one_axis_keeps_in_what_was_held_out_is_not_hidden_by_the_others);
  return UNITY_END();
}
