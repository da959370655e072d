// Which of many numbers stay, and with what values: against least squares in closed form.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/families/candidates.hpp"
#include "diagnosis/families/elimination.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Chosen;
using diagnosis::Dictionary;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::Course;
using test::DrivenRobot;

namespace {

constexpr int kJoint = 2;

double hum(double time) { return std::sin(3 * time); }
double nearly_hum(double time) { return std::sin(3 * time) + 1e-6 * std::cos(5 * time); }
double whistle(double time) { return std::cos(7 * time); }
double drift(double time) { return time / 40; }

const DrivenRobot& robot() {
  static const DrivenRobot driven;
  return driven;
}

Hypothesis hypothesis_of(const char* name, const std::vector<Course>& courses, double lower) {
  Hypothesis hypothesis(test::adding(name, courses), kJoint, robot().robot);
  hypothesis.set_bounds(std::vector<diagnosis::Bounds>(courses.size(), {lower, 1000, 0.1}));
  return hypothesis;
}

/// The numbers that stay for torques that a hypothesis alone makes.
std::vector<Chosen> best_for(const Observations& observations,
                             const std::vector<Hypothesis>& hypotheses) {
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  return diagnosis::Elimination(observations, fit(observations, {}, 0), hypotheses, dictionary)
      .best();
}

Observations made_by(const std::vector<std::pair<Hypothesis, diagnosis::Values>>& causes) {
  simulation::Machine truth = robot().machine();
  for (const auto& [hypothesis, values] : causes) {
    hypothesis.apply(values, &truth);
  }
  return robot().observed(truth);
}

const Chosen* find(const std::vector<Chosen>& all, const std::string& name) {
  const auto at = std::find_if(
      all.begin(), all.end(), [&](const Chosen& each) { return each.hypothesis.effect() == name; });
  return at == all.end() ? nullptr : &*at;
}

void what_is_there_stays_and_what_is_not_goes() {
  const std::vector<Hypothesis> all = {hypothesis_of("hum", {hum}, -1000),
                                       hypothesis_of("whistle", {whistle}, -1000),
                                       hypothesis_of("drift", {drift}, -1000)};
  const std::vector<Chosen> best = best_for(made_by({{all[0], {6}}, {all[2], {-9}}}), all);
  TEST_ASSERT_EQUAL_UINT64(2, best.size());
  TEST_ASSERT_DOUBLE_WITHIN(0.5, 6, find(best, "hum")->values.front());
  TEST_ASSERT_DOUBLE_WITHIN(0.7, -9, find(best, "drift")->values.front());
}

/// Hoerl and Kennard's ridge: courses in closed form, held by the tolerances of their numbers.
Eigen::VectorXd ridge(const Observations& observations, const std::vector<Course>& courses,
                      const std::vector<diagnosis::Parameter>& numbers) {
  const Eigen::MatrixXd columns = test::columns_of(observations, kJoint, courses);
  Eigen::MatrixXd held = columns.transpose() * columns;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    held.diagonal()[static_cast<Eigen::Index>(i)] += std::pow(numbers[i].tolerance, -2);
  }
  return held.ldlt().solve(columns.transpose() * observations.residual.head(observations.train));
}

/// A hum of another sign than it can have is none; what is beside it is as if it were not offered.
void a_number_that_would_leave_its_bounds_is_held() {
  const Hypothesis any = hypothesis_of("hum", {hum}, -1000);
  const Hypothesis positive = hypothesis_of("pair", {hum, whistle}, 0);
  const Hypothesis beside = hypothesis_of("drift", {drift}, -1000);
  const Observations observations = made_by({{any, {-2.5}}, {positive, {0, 8}}, {beside, {12}}});
  const std::vector<Chosen> best = best_for(observations, {positive, beside});
  TEST_ASSERT_EQUAL_UINT64(2, best.size());
  const Chosen& pair = *find(best, "pair");
  const Chosen& slope = *find(best, "drift");
  TEST_ASSERT_EQUAL_DOUBLE(0, pair.values[0]);
  const Eigen::VectorXd expected =
      ridge(observations, {whistle, drift},
            {pair.hypothesis.parameters[1], slope.hypothesis.parameters[0]});
  TEST_ASSERT_DOUBLE_WITHIN(0.5, 8, expected[0]);
  TEST_ASSERT_DOUBLE_WITHIN(0.5, 12, expected[1]);
  TEST_ASSERT_DOUBLE_WITHIN(0.02, expected[0], pair.values[1]);
  TEST_ASSERT_DOUBLE_WITHIN(0.02, expected[1], slope.values[0]);
}

/// A number that stays for what another, left out, could have done as well. Both share it where
/// neither is left out, so that the one that stays is as uncertain as half of it.
void what_was_left_out_makes_uncertain_what_stays_in_its_place() {
  constexpr double kTrue = 10;
  const Hypothesis pair = hypothesis_of("pair", {nearly_hum, whistle}, -1000);
  const Hypothesis alone = hypothesis_of("alone", {hum}, -1000);
  const Observations observations = made_by({{alone, {kTrue}}, {pair, {0, 40}}});
  const std::vector<Chosen> best = best_for(observations, {pair, alone});
  TEST_ASSERT_EQUAL_UINT64(1, best.size());
  TEST_ASSERT_EQUAL_STRING("pair", best.front().hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.5, kTrue, best.front().values[0]);
  const Eigen::MatrixXd columns = test::columns_of(observations, kJoint, {nearly_hum, whistle});
  const double certain = std::sqrt((columns.transpose() * columns).inverse()(0, 0));
  TEST_ASSERT_TRUE(best.front().hypothesis.parameters[0].widening * certain > 0.45 * kTrue);
}

void tracked_positions_that_err_slowly_deviate_more_than_noise_of_their_size() {
  const test::SwingingRobot swinging(5);
  const Eigen::Index rows = swinging.rows();
  const Observations observations = swinging.observed(Eigen::MatrixXd::Zero(rows, 3));
  const Eigen::VectorXd noise = observations.residual;
  Eigen::VectorXd slow(noise.size());
  for (Eigen::Index i = 0; i < slow.size(); ++i) {
    const auto row = static_cast<double>(observations.samples[static_cast<std::size_t>(i)].row);
    slow[i] = std::sqrt(2) * std::sin(0.02 * row);
  }
  const double once = diagnosis::deviation_of(observations, noise);
  TEST_ASSERT_DOUBLE_WITHIN(0.2, 1, once);
  // A fortieth of a series, 75 rows, may hang together; the sine turns a quarter of its round in
  // them.
  TEST_ASSERT_TRUE(diagnosis::deviation_of(observations, slow) > 4 * once);
}

/// Positions in millimetres, as it were: no plausible number of this arm moves it by a kilometre.
void nothing_stays_where_no_number_could_matter() {
  const test::SwingingRobot swinging(5);
  const Observations observations =
      swinging.observed(Eigen::MatrixXd::Constant(swinging.rows(), 3, 1000.0));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  diagnosis::Elimination elimination(observations, fit(observations, {}, 0), hypotheses,
                                     dictionary);
  TEST_ASSERT_EQUAL_UINT64(0, elimination.best().size());
}

/// Two numbers that act alike but for a millionth: least squares makes them large and opposite.
void numbers_that_cannot_be_told_apart_stay_near_the_model() {
  constexpr double kTrue = 10;
  const Hypothesis both = hypothesis_of("both", {hum, nearly_hum}, -1e9);
  const Observations observations = made_by({{both, {kTrue, 0}}});
  const std::vector<Chosen> best = best_for(observations, {both});
  TEST_ASSERT_EQUAL_UINT64(1, best.size());
  const diagnosis::Values& found = best.front().values;

  const Eigen::VectorXd wild = test::columns_of(observations, kJoint, {hum, nearly_hum})
                                   .colPivHouseholderQr()
                                   .solve(observations.residual.head(observations.train));
  TEST_ASSERT_TRUE(wild.cwiseAbs().maxCoeff() > 10 * kTrue);
  TEST_ASSERT_DOUBLE_WITHIN(0.03 * kTrue, kTrue, found[0] + found[1]);
  TEST_ASSERT_DOUBLE_WITHIN(0.1 * kTrue, kTrue / 2, found[0]);
  const Eigen::VectorXd expected =
      ridge(observations, {hum, nearly_hum}, best.front().hypothesis.parameters);
  TEST_ASSERT_DOUBLE_WITHIN(0.01, expected[0], found[0]);
  TEST_ASSERT_DOUBLE_WITHIN(0.01, expected[1], found[1]);
}

/// Both are bodies on the flange, one of them by itself, the other as a part of the link.
void a_load_says_what_the_last_links_mass_does_and_no_other_links() {
  simulation::Machine truth = robot().machine();
  truth.robot.elastic.payload_mass = 60;
  truth.robot.elastic.payload_center = {0.1, 0.15, 0.2};
  const Observations observations = robot().observed(truth);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  const auto load = std::find_if(hypotheses.begin(), hypotheses.end(),
                                 [](const Hypothesis& each) { return each.effect() == "payload"; });
  const diagnosis::Fit found = fit(observations, {{*load, {60, 6, 9, 12}}}, 3);
  const Eigen::MatrixXd said = diagnosis::what_is_said(found, 1, observations.train);
  const auto is_said_of = [&](int joint) {
    const Hypothesis mass(effects::find_law("link_mass", "mounted"), joint, robot().robot);
    const diagnosis::Entry* entry = dictionary.find(mass);
    TEST_ASSERT_NOT_NULL(entry);
    return diagnosis::is_said(
        dictionary.columns.middleCols(entry->first, entry->count).topRows(observations.train),
        said);
  };
  TEST_ASSERT_TRUE(is_said_of(6));
  TEST_ASSERT_FALSE(is_said_of(3));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_is_there_stays_and_what_is_not_goes);
  RUN_TEST(a_number_that_would_leave_its_bounds_is_held);
  RUN_TEST(what_was_left_out_makes_uncertain_what_stays_in_its_place);
  RUN_TEST(tracked_positions_that_err_slowly_deviate_more_than_noise_of_their_size);
  RUN_TEST(nothing_stays_where_no_number_could_matter);
  RUN_TEST(numbers_that_cannot_be_told_apart_stay_near_the_model);
  RUN_TEST(a_load_says_what_the_last_links_mass_does_and_no_other_links);
  return UNITY_END();
}
