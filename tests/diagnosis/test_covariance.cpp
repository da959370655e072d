// How sure a number is: of correlated scores against Bartlett's weighted sum of products, lag by
// lag; of accelerations against inverse dynamics.
#include "diagnosis/covariance.hpp"
#include "diagnosis/driven_robot.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Observations;

namespace {

constexpr Eigen::Index kSamples = 200;  // of each series
constexpr Eigen::Index kLags = kSamples / 40;

/// Two components of one channel, each a series of its own.
Observations two_series() {
  const test::DrivenRobot robot;
  Observations observations = robot.observed(robot.machine());
  observations.samples.clear();
  for (const Eigen::Index component : {0, 1}) {
    for (Eigen::Index row = 0; row < kSamples; ++row) {
      observations.samples.push_back({0, row, simulation::joint_torque, component});
    }
  }
  return observations;
}

double by_products(const Eigen::VectorXd& series) {
  double sum = series.squaredNorm();
  for (Eigen::Index lag = 1; lag <= kLags; ++lag) {
    const double share = 1 - static_cast<double>(lag) / (kLags + 1);
    sum += 2 * share * series.head(kSamples - lag).dot(series.tail(kSamples - lag));
  }
  return sum;
}

void correlated_scores_widen_by_bartletts_sum_of_their_products() {
  const Eigen::ArrayXd time = Eigen::ArrayXd::LinSpaced(2 * kSamples, 0, 40);
  const Eigen::VectorXd score = time.sin() + 0.3 * (7 * time).cos();
  const double expected =
      (by_products(score.head(kSamples)) + by_products(score.tail(kSamples))) / score.squaredNorm();
  TEST_ASSERT_TRUE(expected > 2);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, expected, correlated_widening(two_series(), score));
}

void scores_that_alternate_do_not_narrow() {
  Eigen::VectorXd score(2 * kSamples);
  for (Eigen::Index i = 0; i < score.size(); ++i) {
    score[i] = i % 2 == 0 ? 1 : -1;
  }
  TEST_ASSERT_DOUBLE_WITHIN(0, 1, correlated_widening(two_series(), score));
}

void poses_one_by_one_are_not_correlated() {
  Observations observations = two_series();
  observations.is_static = true;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1,
                            correlated_widening(observations, Eigen::VectorXd::Ones(2 * kSamples)));
}

/// Torque that a joint's acceleration alone needs on all joints, in a row of a scene.
simulation::JointValues torque_of(const test::DrivenRobot& of, Eigen::Index row,
                                  Eigen::Index joint) {
  const simulation::JointValues q = of.scene.q.row(row).transpose();
  const simulation::JointValues rest = simulation::JointValues::Zero(q.size());
  simulation::JointValues acceleration = rest;
  acceleration[joint] = of.scene.acceleration(row, joint);
  simulation::JointValues torque = simulation::inverse_dynamics(of.robot, q, rest, acceleration) -
                                   simulation::inverse_dynamics(of.robot, q, rest, rest);
  torque[joint] +=
      of.robot.dynamics[static_cast<std::size_t>(joint)].rotor_inertia * acceleration[joint];
  return torque;
}

void accelerations_are_known_to_half_a_percent() {
  const test::DrivenRobot robot;
  const Observations observations = robot.observed(robot.machine());
  const Eigen::MatrixXd error = observations.acceleration_error();
  for (Eigen::Index i = 0; i < observations.train; i += 97) {
    const diagnosis::Sample& at = observations.samples[static_cast<std::size_t>(i)];
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const double expected =
          0.005 * torque_of(robot, at.row, joint)[at.component] / observations.noise[i];
      TEST_ASSERT_DOUBLE_WITHIN(1e-9 + 1e-6 * std::abs(expected), expected, error(i, joint));
    }
  }
}

/// A number that acts as all accelerations of a joint being wrong does: nothing is left, and it is
/// as uncertain as they are.
void what_acts_like_an_acceleration_is_no_surer_than_it() {
  const test::DrivenRobot robot;
  const Observations observations = robot.observed(robot.machine());
  const Eigen::MatrixXd error = observations.acceleration_error();
  const Eigen::MatrixXd derivative = error.col(1) / 0.005;
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(error.rows());
  const Eigen::MatrixXd covariance =
      covariance_of(observations, diagnosis::inverse_of(derivative, one, Eigen::VectorXd::Zero(1)),
                    derivative, one, Eigen::VectorXd::Zero(error.rows()), 1e-12);
  const Eigen::VectorXd shift = error.transpose() * derivative / derivative.squaredNorm();
  TEST_ASSERT_TRUE(covariance(0, 0) > 0.005 * 0.005);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, shift.squaredNorm(), covariance(0, 0));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(correlated_scores_widen_by_bartletts_sum_of_their_products);
  RUN_TEST(scores_that_alternate_do_not_narrow);
  RUN_TEST(poses_one_by_one_are_not_correlated);
  RUN_TEST(accelerations_are_known_to_half_a_percent);
  RUN_TEST(what_acts_like_an_acceleration_is_no_surer_than_it);
  return UNITY_END();
}
