// Which of many numbers that were fitted together stand as findings.
#include <algorithm>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/families/without.hpp"
#include "diagnosis/select/members.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Chosen;
using diagnosis::Dictionary;
using diagnosis::Finding;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::Course;
using test::DrivenRobot;

namespace {

constexpr double kSize = 20;  // N·m

double hum(double time) { return std::sin(3 * time); }
double nearly_hum(double time) { return std::sin(3 * time) + 0.02 * std::cos(5 * time); }
double whistle(double time) { return std::cos(7 * time); }

const DrivenRobot& robot() {
  static const DrivenRobot driven;
  return driven;
}

Chosen chosen_of(const char* name, Course course, int joint, bool is_friction = false) {
  effects::Law law = *test::adding(name, {course});
  law.traits.is_friction = is_friction;
  Hypothesis hypothesis(std::make_shared<const effects::Law>(std::move(law)), joint, robot().robot);
  hypothesis.set_bounds({{-1000, 1000, 0.1}});
  return {hypothesis, {kSize}};
}

/// What stands of a fit to torques that all of its choices make.
std::vector<Finding> standing(const std::vector<Chosen>& causes) {
  simulation::Machine truth = robot().machine();
  for (const Chosen& cause : causes) {
    cause.hypothesis.apply(cause.values, &truth);
  }
  const Observations observations = robot().observed(truth);
  const Dictionary dictionary(observations, {}, [](std::size_t, std::size_t) {});
  const Fit given = fit(observations, {}, 0);
  return members_that_stand({observations, dictionary, 0.01, given}, fit(observations, causes, 8));
}

/// The same torques at three joints, and at the second one in two forms that are nearly alike.
std::vector<Chosen> causes_in_two_forms(bool are_friction) {
  return {chosen_of("whistle", whistle, 1), chosen_of("one", hum, 2, are_friction),
          chosen_of("other", nearly_hum, 2, are_friction), chosen_of("whistle", whistle, 3),
          chosen_of("whistle", whistle, 4)};
}

std::size_t count_at(const std::vector<Finding>& findings, int joint) {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const Finding& each) { return each.chosen.hypothesis.joint == joint; }));
}

void forms_of_friction_that_share_what_they_explain_stand_together_as_one() {
  const std::vector<Finding> findings = standing(causes_in_two_forms(true));
  TEST_ASSERT_EQUAL_UINT64(4, findings.size());
  TEST_ASSERT_EQUAL_UINT64(1, count_at(findings, 2));
}

void other_numbers_that_share_what_they_explain_do_not_stand() {
  const std::vector<Finding> findings = standing(causes_in_two_forms(false));
  TEST_ASSERT_EQUAL_UINT64(3, findings.size());
  TEST_ASSERT_EQUAL_UINT64(0, count_at(findings, 2));
}

void a_shape_is_no_part_of_what_goes_with_an_effect() {
  Hypothesis hypothesis(effects::find_law("friction_hysteresis", "dahl"), 2, robot().robot);
  hypothesis.set_bounds({{0, 1000, 0.1}, {1e-4, 1, 1e-3}});
  const Chosen grip{hypothesis, {kSize, 0.05}};
  simulation::Machine truth = robot().machine();
  hypothesis.apply(grip.values, &truth);
  const Observations observations = robot().observed(truth);
  const Fit whole = fit(observations, {grip}, 0);
  const Eigen::VectorXd expected = fit(observations, {}, 0).remainder;
  const Fit others = diagnosis::Without(observations, whole)({0});
  TEST_ASSERT_TRUE((others.remainder - expected).norm() < 1e-6 * expected.norm());
}

void a_gain_does_not_put_back_what_goes() {
  const Chosen friction = chosen_of("whistle", whistle, 2);
  Hypothesis scale(effects::find_law("torque_gain", ""), 2, robot().robot);
  scale.set_bounds({{-0.5, 1, 0.01}});
  const Chosen gain{scale, {0.3}};
  simulation::Machine truth = robot().machine();
  friction.hypothesis.apply(friction.values, &truth);
  scale.apply(gain.values, &truth);
  const Observations observations = robot().observed(truth);
  const Fit whole = fit(observations, {friction, gain}, 0);
  const Eigen::VectorXd expected = fit(observations, {gain}, 0).remainder;
  const Fit others = diagnosis::Without(observations, whole)({0});
  TEST_ASSERT_TRUE((others.remainder - expected).norm() < 1e-6 * expected.norm());
}

void a_number_that_explains_nothing_does_not_stand_beside_those_that_explain_all() {
  std::vector<Chosen> causes = causes_in_two_forms(true);
  causes.push_back(chosen_of("whistle", whistle, 5));
  causes.back().values = {0};
  TEST_ASSERT_EQUAL_UINT64(0, count_at(standing(causes), 5));
}

/// Remainders of the same observations: as they are, and held-out samples of one stretch changed.
struct Remainders {
  Observations observations = robot().observed(robot().machine());
  Eigen::VectorXd after = observations.residual;

  Eigen::Index first() const { return observations.train; }
};

void samples_that_no_fit_explains_confirm_nothing() {
  Remainders of;
  constexpr double kFarOff = 100;  // deviations
  of.after.segment(of.first(), 20).setConstant(kFarOff);
  Eigen::VectorXd before = of.after;
  before[of.first()] -= 1e-9;
  TEST_ASSERT_TRUE(confirmation_of(of.observations, before, of.after) < 2);
}

void a_sample_confirms_no_more_the_farther_off_it_was() {
  Remainders of;
  const auto confirmed_by = [&](double size) {
    Eigen::VectorXd before = of.after;
    before[of.first()] = size;
    return confirmation_of(of.observations, before, of.after);
  };
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, confirmed_by(20), confirmed_by(1e6));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(forms_of_friction_that_share_what_they_explain_stand_together_as_one);
  RUN_TEST(other_numbers_that_share_what_they_explain_do_not_stand);
  RUN_TEST(a_shape_is_no_part_of_what_goes_with_an_effect);
  RUN_TEST(a_gain_does_not_put_back_what_goes);
  RUN_TEST(a_number_that_explains_nothing_does_not_stand_beside_those_that_explain_all);
  RUN_TEST(samples_that_no_fit_explains_confirm_nothing);
  RUN_TEST(a_sample_confirms_no_more_the_farther_off_it_was);
  return UNITY_END();
}
