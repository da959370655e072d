// How much less correlated scores tell: against Bartlett's weighted sum of products, lag by lag.
#include "diagnosis/covariance.hpp"
#include "diagnosis/driven_robot.hpp"
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

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(correlated_scores_widen_by_bartletts_sum_of_their_products);
  RUN_TEST(scores_that_alternate_do_not_narrow);
  RUN_TEST(poses_one_by_one_are_not_correlated);
  return UNITY_END();
}
