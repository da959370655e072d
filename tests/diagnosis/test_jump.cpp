// A jump of the measured place is no drift.
#include <algorithm>
#include <cmath>

#include "diagnosis/jump.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Jump;
using diagnosis::Observations;
using test::kTcpNoise;
using test::SwingingRobot;

namespace {

constexpr double kSize = 30 * kTcpNoise;  // m
constexpr double kMoment = 23;            // s, of 40

const SwingingRobot& robot() {
  static const SwingingRobot swinging(3);
  return swinging;
}

/// The TCP's error along x and z by a course of time.
Observations observed(double (*course)(double time)) {
  const Eigen::VectorXd error = kSize * robot().recording.time.unaryExpr(course);
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(error.size(), 3);
  errors.col(0) = error;
  errors.col(2) = -0.5 * error;
  return robot().observed(errors);
}

double jump(double time) { return time < kMoment ? 0 : 1; }
double warming(double time) { return 1 - std::exp(-time / 60); }

/// The drift of the TCP with time, fitted.
Fit drift(const Observations& observations) {
  const std::vector<Hypothesis> all = all_hypotheses(observations);
  const auto found = std::find_if(all.begin(), all.end(), [](const Hypothesis& each) {
    return each.effect() == "thermal_drift" && each.law->form == "time";
  });
  return fit(observations, {{*found, {0, 0, 0, 60}}}, 20);
}

bool jumps(const Observations& observations) {
  return diagnosis::jumps_instead(observations, fit(observations, {}, 0), drift(observations));
}

void a_jump_accounts_for_more_of_a_jump_than_a_drift_does() {
  TEST_ASSERT_TRUE(jumps(observed(jump)));
}

void a_jump_does_not_account_for_more_of_a_drift() { TEST_ASSERT_FALSE(jumps(observed(warming))); }

void the_moment_of_a_jump_is_told_and_it_leaves_the_noise() {
  const Observations observations = observed(jump);
  const Jump found = jump_of_place(observations, fit(observations, {}, 0));
  TEST_ASSERT_DOUBLE_WITHIN(1, kMoment, found.time);
  TEST_ASSERT_EQUAL_UINT64(4, found.numbers);
  const double before = observations.residual.head(observations.train).squaredNorm();
  TEST_ASSERT_TRUE(found.left < 0.05 * before);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_jump_accounts_for_more_of_a_jump_than_a_drift_does);
  RUN_TEST(a_jump_does_not_account_for_more_of_a_drift);
  RUN_TEST(the_moment_of_a_jump_is_told_and_it_leaves_the_noise);
  return UNITY_END();
}
