// What of a mismatch no model explains, joint by joint, and fits that weigh by it.
#include <random>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/model_error.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Fit;
using diagnosis::Observations;
using test::DrivenRobot;

namespace {

const Observations& observed() {
  static const DrivenRobot driven;
  static const Observations observations = driven.observed(driven.machine());
  return observations;
}

/// A remainder that is five times the noise at joint 2, half the noise at joint 3, else the noise.
Eigen::VectorXd remainder() {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd values(observed().size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Eigen::Index joint = observed().samples[static_cast<std::size_t>(i)].component;
    values[i] = (joint == 1 ? 5 : joint == 2 ? 0.5 : 1) * normal(random);
  }
  return values;
}

double factor_of(Eigen::Index joint, const Eigen::VectorXd& factors) {
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    if (observed().samples[static_cast<std::size_t>(i)].component == joint) {
      return factors[i];
    }
  }
  return 0;
}

void a_joint_counts_by_what_is_left_of_it_and_never_below_its_noise() {
  const Eigen::VectorXd factors = model_error(observed(), remainder().head(observed().train));
  TEST_ASSERT_DOUBLE_WITHIN(0.5, 5, factor_of(1, factors));
  TEST_ASSERT_EQUAL_DOUBLE(1, factor_of(2, factors));
  TEST_ASSERT_DOUBLE_WITHIN(0.1, 1, factor_of(0, factors));
}

void single_samples_far_off_do_not_decide() {
  Eigen::VectorXd values = remainder();
  for (Eigen::Index i = 0; i < observed().train; i += 200) {
    values[i] = 1000;
  }
  const Eigen::VectorXd factors = model_error(observed(), values.head(observed().train));
  TEST_ASSERT_DOUBLE_WITHIN(0.7, 5, factor_of(1, factors));
  TEST_ASSERT_DOUBLE_WITHIN(0.2, 1, factor_of(0, factors));
}

void a_fit_over_another_noise_leaves_the_same() {
  const Fit given = fit(observed(), {}, 0);
  const Eigen::VectorXd factors = model_error(observed(), remainder().head(observed().train));
  Observations doubtful = observed();
  doubtful.add_model_error(factors);
  const Fit converted = over_noise(given, factors, observed().train);
  const double before = observed().rms(given.remainder, simulation::joint_torque, true);
  const double after = doubtful.rms(converted.remainder, simulation::joint_torque, true);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9 * before, before, after);
  // Times the noise of the measurement, it is the same too.
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, largest_ratio(observed(), given.remainder),
                            largest_ratio(doubtful, converted.remainder));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_joint_counts_by_what_is_left_of_it_and_never_below_its_noise);
  RUN_TEST(single_samples_far_off_do_not_decide);
  RUN_TEST(a_fit_over_another_noise_leaves_the_same);
  return UNITY_END();
}
