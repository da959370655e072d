// Which form of a law a finding takes, and how sure its numbers are beside the other forms.
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/select/forms.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Choice;
using diagnosis::Dictionary;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::DrivenRobot;

namespace {

constexpr int kJoint = 2;
constexpr double kTorque = 20;  // N·m
constexpr double kSlip = 0.05;  // rad

Hypothesis grip(const char* form) {
  static const DrivenRobot driven;
  Hypothesis hypothesis(effects::find_law("friction_hysteresis", form), kJoint, driven.robot);
  hypothesis.set_bounds({{0, 1000, 0.1}, {1e-3, 1, 1e-3}});
  return hypothesis;
}

/// A choice of one finding in one form, of a robot that has it in another.
Choice settled(const char* found, const char* real, double torque = kTorque) {
  static const DrivenRobot driven;
  simulation::Machine truth = driven.machine();
  grip(real).apply({torque, kSlip}, &truth);
  const Observations observations = driven.observed(truth);
  const Dictionary dictionary(observations, {grip("slider"), grip("dahl")},
                              [](std::size_t, std::size_t) {});
  const Fit given = fit(observations, {}, 0);
  const diagnosis::Inquiry inquiry{observations, dictionary, 0.01, given};
  Choice choice;
  choice.fit = fit(observations, {{grip(found), {torque, kSlip}}}, 20);
  choice.findings.push_back(judge(inquiry, choice.fit, 0));
  choice.findings[0].covariance = choice.fit.covariance_of(0);
  settle_forms(inquiry, &choice);
  return choice;
}

void the_form_that_fits_and_predicts_better_is_taken() {
  const Choice choice = settled("dahl", "slider");
  TEST_ASSERT_EQUAL_STRING("slider", choice.findings[0].chosen.hypothesis.law->form.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kSlip, kSlip, choice.findings[0].chosen.values[1]);
}

void a_form_that_is_clearly_worse_changes_nothing() {
  const Choice choice = settled("slider", "slider");
  TEST_ASSERT_EQUAL_STRING("slider", choice.findings[0].chosen.hypothesis.law->form.c_str());
  const double own = choice.fit.covariance(1, 1);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9 * own, own, choice.findings[0].covariance(1, 1));
}

void the_interval_holds_forms_that_fit_as_well() {
  const Choice choice = settled("slider", "dahl", 2);  // as large as the noise
  const double deviation = std::sqrt(choice.findings[0].covariance(1, 1));
  TEST_ASSERT_TRUE(deviation > std::sqrt(choice.fit.covariance(1, 1)));
  TEST_ASSERT_DOUBLE_WITHIN(2 * deviation, kSlip, choice.findings[0].chosen.values[1]);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_form_that_fits_and_predicts_better_is_taken);
  RUN_TEST(a_form_that_is_clearly_worse_changes_nothing);
  RUN_TEST(the_interval_holds_forms_that_fit_as_well);
  return UNITY_END();
}
