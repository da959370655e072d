// How sure a finding's numbers are beside causes that the recordings cannot rule out.
#include <cmath>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/parameters.hpp"
#include "diagnosis/select/confounders.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Choice;
using diagnosis::Dictionary;
using diagnosis::Finding;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::kTold;
using diagnosis::Observations;
using test::adding;
using test::Course;
using test::DrivenRobot;

namespace {

constexpr int kJoint = 2;
constexpr double kSize = 10;  // N·m, of what is found

double found(double time) { return std::cos(time); }
double twin(double time) { return std::cos(time) + 0.01 * std::sin(7 * time); }
double relative(double time) { return std::cos(time) + 0.5 * std::sin(3 * time); }
double stranger(double time) { return std::sin(3 * time); }

const DrivenRobot& driven() {
  static const DrivenRobot robot;
  return robot;
}

Hypothesis hypothesis_of(const char* name, Course course) {
  Hypothesis hypothesis(adding(name, {course}), kJoint, driven().robot);
  hypothesis.set_bounds({{-100, 100, 1}});
  return hypothesis;
}

/// The finding of a cosine on a machine that has another cause besides, of such a size. About the
/// fit the cosine's derivative is bent by a part of a strange course.
Finding found_beside(const char* name, Course course, double size, double bent = 0) {
  const Hypothesis cause = hypothesis_of("cosine", found);
  const Hypothesis other = hypothesis_of(name, course);
  simulation::Machine truth = driven().machine();
  cause.apply({kSize}, &truth);
  other.apply({size}, &truth);
  const Observations observations = driven().observed(truth);
  const Dictionary dictionary(observations, {cause, other}, [](std::size_t, std::size_t) {});
  const Fit given = fit(observations, {}, 0);
  Choice choice;
  choice.fit = fit(observations, {{cause, {kSize}}}, 20);
  const Dictionary bends(observations, {hypothesis_of("bend", stranger)},
                         [](std::size_t, std::size_t) {});
  choice.fit.derivative += bent * bends.columns;
  choice.findings.push_back(
      {choice.fit.chosen[0], choice.fit.covariance_of(0), {}, {}, {}, {}, {}});
  widen_by_confounders({observations, dictionary, 0.01, given}, &choice);
  return choice.findings[0];
}

double error_of(const Finding& finding) { return std::abs(finding.chosen.values[0] - kSize); }
double side_alone(const Finding& finding) { return kTold * std::sqrt(finding.covariance(0, 0)); }
double side_of(const Finding& finding) {
  return kTold * std::sqrt(finding.whole_covariance()(0, 0));
}

void a_cause_that_would_not_show_is_in_the_interval() {
  const Finding finding = found_beside("twin", twin, 2);
  TEST_ASSERT_TRUE(error_of(finding) > side_alone(finding));
  TEST_ASSERT_TRUE(error_of(finding) < side_of(finding));
  TEST_ASSERT_EQUAL_INT(1, finding.confounders.size());
  TEST_ASSERT_EQUAL_STRING("twin", finding.confounders[0].effect.c_str());
  TEST_ASSERT_EQUAL_INT(kJoint, finding.confounders[0].joint);
}

void a_cause_that_would_not_show_is_taken_for_a_quarter_of_what_was_found() {
  const Finding finding = found_beside("twin", twin, 0);
  TEST_ASSERT_DOUBLE_WITHIN(0.02 * kSize, 0.25 * kSize, side_of(finding) / kTold);
}

void a_cause_that_would_show_and_does_not_changes_little() {
  const Finding finding = found_beside("relative", relative, 0);
  TEST_ASSERT_TRUE(side_of(finding) < 1.2 * side_alone(finding));
  TEST_ASSERT_EQUAL_INT(0, finding.confounders.size());
}

void a_cause_that_shows_though_it_was_not_named_is_in_the_interval() {
  const Finding finding = found_beside("relative", relative, 1);
  TEST_ASSERT_TRUE(error_of(finding) > side_alone(finding));
  TEST_ASSERT_TRUE(error_of(finding) < side_of(finding));
}

void a_cause_that_changes_other_samples_makes_nothing_uncertain() {
  const Finding finding = found_beside("stranger", stranger, 3);
  TEST_ASSERT_TRUE(side_of(finding) < 1.2 * side_alone(finding));
  TEST_ASSERT_EQUAL_INT(0, finding.confounders.size());
}

void a_twin_does_the_same_though_the_fit_is_bent() {
  const Finding finding = found_beside("same", found, 2, 0.5);
  TEST_ASSERT_TRUE(error_of(finding) < side_of(finding));
  TEST_ASSERT_EQUAL_INT(1, finding.confounders.size());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_cause_that_would_not_show_is_in_the_interval);
  RUN_TEST(a_cause_that_would_not_show_is_taken_for_a_quarter_of_what_was_found);
  RUN_TEST(a_cause_that_would_show_and_does_not_changes_little);
  RUN_TEST(a_cause_that_shows_though_it_was_not_named_is_in_the_interval);
  RUN_TEST(a_cause_that_changes_other_samples_makes_nothing_uncertain);
  RUN_TEST(a_twin_does_the_same_though_the_fit_is_bent);
  return UNITY_END();
}
