// Stated deviations against errors that are known, and amplitudes within bounds.
#include <cmath>

#include "diagnosis/covariance.hpp"
#include "diagnosis/fit.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/parameters.hpp"
#include "diagnosis/search/search.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp::diagnosis;
using flexcomp::test::kTcpNoise;
using flexcomp::test::SwingingRobot;

namespace {

constexpr int kJoint = 3;

/// Each with the one before in common, by as much as makes them hang together for half a second.
Eigen::MatrixXd hanging_together(const SwingingRobot& swinging, double deviation, unsigned seed) {
  constexpr double kStays = 0.98;  // from one row, of 10 ms, to the next
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, deviation * std::sqrt(1 - kStays * kStays));
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(swinging.rows(), 3);
  for (Eigen::Index row = 1; row < errors.rows(); ++row) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      errors(row, axis) = kStays * errors(row - 1, axis) + normal(random);
    }
  }
  return errors;
}

/// An error that belongs to the posture, the same in every round: smooth, of a random course.
Eigen::MatrixXd by_posture(const SwingingRobot& swinging, double deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(swinging.rows(), 3);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (int wave = 0; wave < 4; ++wave) {
      const Eigen::VectorXd direction =
          10 * Eigen::VectorXd::NullaryExpr(5, [&] { return normal(random); });
      const double phase = 3 * normal(random);
      errors.col(axis) +=
          (deviation / std::sqrt(2)) *
          ((swinging.scene.q.leftCols(5) * direction).array() + phase).sin().matrix();
    }
  }
  return errors;
}

struct Estimated {
  double value;
  double deviation;
};

Estimated offset_of(const Observations& observations) {
  Hypothesis hypothesis(flexcomp::effects::find_law("joint_offset", ""), kJoint,
                        observations.machine.robot);
  TEST_ASSERT_TRUE(search::joint_offset().prepare(observations, &hypothesis));
  const Fit found = fit(observations, {{hypothesis, {0.0}}}, 12);
  return {found.chosen[0].values[0], std::sqrt(found.covariance(0, 0))};
}

/// Number of true values that lie within 1.96 stated deviations.
int intervals_that_hold(double together, double* mean_deviation) {
  constexpr double kOffset = 1e-4;  // rad
  constexpr int kRounds = 40;
  int hold = 0;
  *mean_deviation = 0;
  for (unsigned seed = 1; seed <= kRounds; ++seed) {
    const SwingingRobot swinging(seed);
    const Eigen::MatrixXd error =
        swinging.moved_by(kJoint, Eigen::VectorXd::Constant(swinging.rows(), kOffset)) +
        hanging_together(swinging, together, 100 + seed);
    const Estimated found = offset_of(swinging.observed(error));
    hold += std::abs(found.value - kOffset) < 1.96 * found.deviation ? 1 : 0;
    *mean_deviation += found.deviation / kRounds;
  }
  return hold;
}

void intervals_hold_in_noise_and_are_no_wider_than_they_must() {
  double stated = 0;
  TEST_ASSERT_TRUE(intervals_that_hold(0, &stated) >= 35);  // 38 of 40; fewer than 35 by chance 1 %
  const SwingingRobot swinging(1);
  const Eigen::MatrixXd lever = swinging.moved_by(kJoint, Eigen::VectorXd::Ones(swinging.rows()));
  const double least = kTcpNoise / (std::sqrt(0.75) * lever.norm());  // a quarter is held out
  TEST_ASSERT_TRUE(stated > 0.95 * least);
  TEST_ASSERT_TRUE(stated < 1.25 * least);
}

void intervals_hold_where_errors_hang_together() {
  double stated = 0;
  TEST_ASSERT_TRUE(intervals_that_hold(kTcpNoise, &stated) >= 34);
}

void intervals_hold_where_what_is_left_belongs_to_the_posture() {
  constexpr double kOffset = 1e-4;  // rad
  int hold = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const SwingingRobot swinging(seed, true);
    const Eigen::MatrixXd error =
        swinging.moved_by(kJoint, Eigen::VectorXd::Constant(swinging.rows(), kOffset)) +
        by_posture(swinging, kTcpNoise, 200 + seed);
    const Estimated found = offset_of(swinging.observed(error));
    hold += std::abs(found.value - kOffset) < 1.96 * found.deviation ? 1 : 0;
  }
  TEST_ASSERT_TRUE(hold >= 34);
}

void a_fit_begins_where_the_robot_comes_to_rest() {
  constexpr double kTooSoft = 0.01;  // rad/(N·m): the weight of the arm turns it over
  SwingingRobot swinging(1);
  swinging.robot.elastic.gravity = {0, 0, -9.81};
  const Observations observations = swinging.observed();
  Hypothesis spring(flexcomp::effects::find_law("joint_stiffness", ""), 2,
                    observations.machine.robot);
  TEST_ASSERT_TRUE(search::joint_stiffness().prepare(observations, &spring));
  const Fit found = fit(observations, {{spring, {kTooSoft}}}, 12);
  TEST_ASSERT_TRUE(found.train_sum < fit(observations, {}, 0).train_sum);
}

/// A law that says it acts.
flexcomp::effects::LawPointer made_up(const std::vector<flexcomp::effects::Parameter>& parameters,
                                      std::size_t linear_in) {
  flexcomp::effects::Law law;
  law.traits.linear_in = linear_in;
  law.parameters = [parameters](const flexcomp::model::Robot&, int) { return parameters; };
  law.statement = [](int) { return "something acts"; };
  return std::make_shared<const flexcomp::effects::Law>(std::move(law));
}

/// Something of some amplitude and shape, the shape known to 0.1.
struct Shaped {
  Shaped(double amplitude, double deviation) {
    hypothesis.set_bounds({{-9999, 9999, 1}, {-4, 4, 0.1}});
    Fit& fit = diagnosis.choice.fit;
    fit.chosen = {{hypothesis, {amplitude, 0.7}}};
    fit.covariance = Eigen::Vector2d(deviation * deviation, 0.01).asDiagonal();
    fit.remainder = Eigen::VectorXd::Ones(observations.size());
    Fit without;
    without.remainder = 2 * fit.remainder;
    diagnosis.choice.findings.push_back({fit.chosen[0], fit.covariance, {}, without, {}, {}, {}});
  }

  const SwingingRobot swinging{1};
  const Observations observations = swinging.observed(Eigen::MatrixXd::Zero(swinging.rows(), 3));
  Hypothesis hypothesis{made_up({{"amplitude", "N·m"}, {"shape", "rad"}}, 1), 0,
                        observations.machine.robot};
  Diagnosis diagnosis;
};

void the_shape_of_what_cannot_be_told_from_nothing_is_unknown() {
  const Shaped sure(-3000, 1000);
  const Shaped unsure(-1500, 1000);
  const auto of = [](const Shaped& shaped) {
    return estimates(shaped.observations, shaped.diagnosis.choice.findings[0].chosen,
                     shaped.diagnosis.choice.findings[0].covariance);
  };
  TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.1, of(sure)[1].deviation);
  TEST_ASSERT_DOUBLE_WITHIN(1, 1000, of(unsure)[0].deviation);
  TEST_ASSERT_TRUE(std::isnan(of(unsure)[1].deviation));
}

void no_number_is_told_better_than_laws_are_exact() {
  const Shaped certain(-3000, 1);
  const double deviation =
      estimates(certain.observations, certain.diagnosis.choice.findings[0].chosen,
                certain.diagnosis.choice.findings[0].covariance)[0]
          .deviation;
  TEST_ASSERT_DOUBLE_WITHIN(0.1, 15, deviation);  // half a percent
}

void a_number_that_may_be_anything_that_it_can_be_is_not_told() {
  const auto deviation_of = [](double deviation) {
    const Shaped shaped(-3000, deviation);
    const auto& found = shaped.diagnosis.choice.findings[0];
    return estimates(shaped.observations, found.chosen, found.covariance)[0].deviation;
  };
  TEST_ASSERT_TRUE(std::isnan(deviation_of(1e9)));
  TEST_ASSERT_FALSE(std::isnan(deviation_of(1000)));
}

void a_finding_is_summed_up_by_the_numbers_that_are_told_from_nothing() {
  const auto said = [](const Shaped& shaped) {
    return statement(shaped.observations, shaped.diagnosis, 0);
  };
  TEST_ASSERT_EQUAL_STRING_LEN(
      "Something acts (amplitude -9000 N·m, shape 0.7 rad), which the model lacks",
      said({-9000, 1000}).c_str(), 75);
  TEST_ASSERT_EQUAL_STRING_LEN("Something acts, which the model lacks", said({-1500, 1000}).c_str(),
                               37);
}

void a_parameter_counts_by_what_the_samples_tell_of_it() {
  Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(10, 4);
  derivative(0, 0) = derivative(1, 1) = derivative(2, 2) = 2;
  const Eigen::VectorXd weight = Eigen::VectorXd::Ones(10);
  const Eigen::Vector4d held(0, 4, 12, 0);
  // The samples give each of the first three 4; what holds them gives 0, 4 and 12.
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1 + 1.0 / 2 + 1.0 / 4 + 1,
                            told_parameters(inverse_of(derivative, weight, held), held));
}

/// The TCP is off along x. In the scene that is held out, only a small shift has a prediction.
void a_fit_has_a_prediction_where_it_is_checked_as_well() {
  constexpr double kTrue = 3e-3;  // m
  constexpr double kMost = 2e-3;  // m, in the other scene
  flexcomp::effects::Law law;
  law.traits.linear_in = 1;
  law.parameters = [](const flexcomp::model::Robot&, int) {
    return std::vector<flexcomp::effects::Parameter>{{"shift", "m"}};
  };
  law.apply = [](const Values& values, int, Machine* machine) {
    const double shift = values[0];
    machine->terms.push_back(
        {flexcomp::simulation::Term::instrument,
         [shift](const Scene& scene, const Simulation&, Prediction* prediction) {
           const double bounded = scene.file == "other" ? 0 * std::sqrt(kMost - shift) : 0;
           prediction->channel[flexcomp::simulation::tcp_position].col(0).array() +=
               shift + bounded;
         }});
  };
  const SwingingRobot swinging(1);
  Eigen::MatrixXd error = Eigen::MatrixXd::Zero(swinging.rows(), 3);
  error.col(0).setConstant(kTrue);
  std::vector<Scene> scenes = {swinging.observed(error).scenes.front(),
                               swinging.observed(error).scenes.front()};
  scenes.back().file = "other";
  const Observations observations(flexcomp::effects::machine_of(swinging.robot, scenes), scenes, 1);
  Hypothesis hypothesis(std::make_shared<const flexcomp::effects::Law>(law), 0, swinging.robot);
  hypothesis.set_bounds({{-1, 1, 1e-3}});
  const Fit found = fit(observations, {{hypothesis, {1e-3}}}, 12);
  TEST_ASSERT_TRUE(found.remainder.allFinite());
  TEST_ASSERT_TRUE(found.chosen[0].values[0] >= 1e-3 && found.chosen[0].values[0] <= kMost);
}

Hypothesis of_two(double lower) {
  Hypothesis hypothesis(made_up({{"a", "1"}, {"b", "1"}}, 2), 0, {});
  hypothesis.set_bounds({{lower, 10, 1e-3}, {lower, 10, 1e-3}});
  return hypothesis;
}

void amplitudes_of_two_hypotheses_that_leave_their_bounds_are_held_at_zero() {
  const Hypothesis one = of_two(0);
  const Hypothesis other = of_two(-10);
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(50, 4);
  const Eigen::VectorXd target =
      columns * Eigen::Vector4d(1, -2, -3, 4) + 0.01 * Eigen::VectorXd::Random(50);
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const LeastSquares found = solve_within_bounds({&one, &other}, gram, columns.transpose() * target,
                                                 gram.diagonal().cwiseSqrt());
  Eigen::MatrixXd left(50, 3);
  left << columns.col(0), columns.col(2), columns.col(3);
  const Eigen::Vector3d expected = left.colPivHouseholderQr().solve(target);
  TEST_ASSERT_EQUAL_DOUBLE(0, found.amplitude[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, expected[0], found.amplitude[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, expected[1], found.amplitude[2]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, expected[2], found.amplitude[3]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, target.squaredNorm() - (target - left * expected).squaredNorm(),
                            found.gain);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(intervals_hold_in_noise_and_are_no_wider_than_they_must);
  RUN_TEST(intervals_hold_where_errors_hang_together);
  RUN_TEST(intervals_hold_where_what_is_left_belongs_to_the_posture);
  RUN_TEST(a_fit_begins_where_the_robot_comes_to_rest);
  RUN_TEST(a_fit_has_a_prediction_where_it_is_checked_as_well);
  RUN_TEST(the_shape_of_what_cannot_be_told_from_nothing_is_unknown);
  RUN_TEST(no_number_is_told_better_than_laws_are_exact);
  RUN_TEST(a_number_that_may_be_anything_that_it_can_be_is_not_told);
  RUN_TEST(a_finding_is_summed_up_by_the_numbers_that_are_told_from_nothing);
  RUN_TEST(a_parameter_counts_by_what_the_samples_tell_of_it);
  RUN_TEST(amplitudes_of_two_hypotheses_that_leave_their_bounds_are_held_at_zero);
  return UNITY_END();
}
