// Laws that nobody listed: found where they act, by what drives them, and not where nothing does.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/grammar/compose.hpp"
#include "diagnosis/grammar/laws.hpp"
#include "diagnosis/grammar/normal.hpp"
#include "diagnosis/grammar/shape.hpp"
#include "diagnosis/grammar/wave.hpp"
#include "diagnosis/output/law_picture.hpp"
#include "diagnosis/parameters.hpp"
#include "diagnosis/search/search.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Choice;
using flexcomp::diagnosis::Dictionary;
using flexcomp::diagnosis::Finding;
using flexcomp::diagnosis::Fit;
using flexcomp::diagnosis::Hypothesis;
using flexcomp::diagnosis::Inquiry;
using flexcomp::diagnosis::Observations;
using flexcomp::test::DrivenRobot;
namespace grammar = flexcomp::diagnosis::grammar;
namespace simulation = flexcomp::simulation;

namespace {

/// A torque (N·m) of a joint by what the machine does.
using Torque = Eigen::VectorXd (*)(const simulation::Simulation& at);

simulation::Machine with(const DrivenRobot& robot, int joint, Torque torque) {
  simulation::Machine truth = robot.machine();
  truth.terms.push_back(
      {simulation::Term::output, [=](const simulation::Scene&, const simulation::Simulation& at,
                                     simulation::Prediction* prediction) {
         prediction->channel[simulation::joint_torque].col(joint - 1) += torque(at);
       }});
  return truth;
}

Observations observed(const DrivenRobot& robot, int joint, Torque torque) {
  return robot.observed(with(robot, joint, torque));
}

/// Laws beside a catalogue without one of its effects.
Choice laws_in(const Observations& observations, grammar::Budget* budget,
               const std::string& without = "") {
  std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(),
                                  [&](const Hypothesis& each) { return each.effect() == without; }),
                   hypotheses.end());
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  const Fit given = fit(observations, {}, 0);
  const Inquiry inquiry{observations, dictionary, 0.01, given};
  grammar::LawSearch laws(inquiry, budget, [](const std::string&) {});
  return laws.choose(given, grammar::First::any);
}

Choice laws_in(const Observations& observations) {
  grammar::Budget budget(600);
  return laws_in(observations, &budget);
}

/// Part of the held-out error beyond the noise that is left.
double left_of(const Observations& observations, const Choice& choice) {
  const auto squares = [&](const Eigen::VectorXd& values) {
    const Eigen::Index held_out = observations.size() - observations.train;
    return values.tail(held_out).squaredNorm() - static_cast<double>(held_out);
  };
  return squares(choice.fit.remainder) / squares(observations.residual);
}

/// The only finding of the laws for a torque of joint 5.
Finding only_law(const Observations& observations) {
  const Choice choice = laws_in(observations);
  TEST_ASSERT_EQUAL_UINT64(1, choice.findings.size());
  TEST_ASSERT_TRUE(left_of(observations, choice) < 0.02);
  const Finding& finding = choice.findings.front();
  TEST_ASSERT_EQUAL_STRING("law", finding.chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL_INT(5, finding.chosen.hypothesis.joint);
  TEST_ASSERT_EQUAL_STRING("joint_torque", finding.chosen.hypothesis.law->written->place.c_str());
  return finding;
}

void noise_alone_has_no_law() {
  const DrivenRobot robot;
  TEST_ASSERT_TRUE(laws_in(robot.observed(robot.machine())).findings.empty());
}

void a_hose_that_another_joint_pulls_is_a_wave_of_its_angle() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(40 * (3 * at.q.col(3).array() + 0.7).sin());
  }));
  TEST_ASSERT_EQUAL_STRING("a*sin(3*q4) + b*cos(3*q4)",
                           found.chosen.hypothesis.law->written->formula.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(1, 40 * std::cos(0.7), found.chosen.values[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1, 40 * std::sin(0.7), found.chosen.values[1]);
  TEST_ASSERT_TRUE(found.chosen.hypothesis.statement().find("usually a cable or hose") !=
                   std::string::npos);
}

void friction_that_another_joints_angle_raises_is_followed() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(at.velocity.col(4).array().sign() * (20 + 60 * at.q.col(2).array()));
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.rfind("a*q3*sign(v5)", 0) == 0, formula.c_str());
}

void friction_of_a_gear_that_drives_follows_its_power() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd speed = at.velocity.col(4).array();
    return Eigen::VectorXd(
        (speed * at.acceleration.col(4).array() > 0).select(40 * speed.sign(), 0));
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  for (const char* part : {"(v5*a5)", "sign(v5)"}) {
    TEST_ASSERT_TRUE_MESSAGE(formula.find(part) != std::string::npos, formula.c_str());
  }
}

void a_wave_that_another_joint_turns_round_is_one_law() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(40 * (20 * at.q.col(4).array()).sin() * (3 * at.q.col(3).array()).cos());
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q5)*cos(3*q4)") != std::string::npos,
                           formula.c_str());
}

/// The laws that are worth a fit.
std::vector<grammar::Composed> composed(const grammar::Material& material) {
  const Observations& observations = material.observations;
  const auto seats = grammar::seats_of(observations, material.rows, fit(observations, {}, 0));
  std::size_t looked_at = 0;
  return grammar::compose(material, grammar::screen(material, seats, &looked_at), {}, &looked_at);
}

/// The first of them that follows a driver by a shape, or the end.
std::vector<grammar::Composed>::const_iterator follows(const std::vector<grammar::Composed>& laws,
                                                       const char* shape, const char* driver) {
  return std::find_if(laws.begin(), laws.end(), [&](const grammar::Composed& each) {
    return std::string(each.form.shape->name) == shape && each.lead.driver->name == driver;
  });
}

/// Few stretches have rows beyond the stop. Halves without most of these prefer another law of two
/// numbers, though the stop fits better.
void a_stop_that_few_stretches_touch_is_weighed() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd angle = at.q.col(4).array();
    const double stop = angle.minCoeff() + 0.1 * (angle.maxCoeff() - angle.minCoeff());
    return Eigen::VectorXd(300 * (stop - angle).max(0));
  });
  const grammar::Material material(observations);
  const auto laws = composed(material);
  TEST_ASSERT_TRUE(std::any_of(laws.begin(), laws.end(), [](const grammar::Composed& each) {
    return std::string(each.form.shape->name) == "stop below" && each.numbers() == 2;
  }));
}

/// A limit that only the driver's peaks reach: noise that is cut off looks so.
void a_law_that_hardly_bends_is_weighed_against_the_line() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd load = at.prediction.dynamic_load.col(3).array();
    const double most = 0.85 * load.abs().maxCoeff();
    return Eigen::VectorXd(60 * load.min(most).max(-most) / most);
  });
  const grammar::Material material(observations);
  const auto laws = composed(material);
  const auto limit = follows(laws, "limit", "tau4");
  TEST_ASSERT_TRUE(limit != laws.end() && limit != laws.begin());
  TEST_ASSERT_EQUAL_STRING("line", std::prev(limit)->form.shape->name);
  TEST_ASSERT_EQUAL_STRING("tau4", std::prev(limit)->lead.driver->name.c_str());
}

/// Its size changes sign half-way, so that the wave by itself takes away next to nothing.
void a_wave_is_seen_though_its_size_is_nothing_on_average() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd other = at.q.col(3).array();
    const Eigen::ArrayXd wave = (50 * at.q.col(4).array() + 0.4).sin();
    return Eigen::VectorXd(40 * wave * (other - other.mean()));
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q5)") != std::string::npos, formula.c_str());
  TEST_ASSERT_TRUE(found.chosen.hypothesis.statement().find("usually the magnets of a motor") !=
                   std::string::npos);
}

void a_wave_whose_size_follows_the_load_is_a_law() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd load = at.prediction.dynamic_load.col(4).array();
    const Eigen::ArrayXd wave = (50 * at.q.col(4).array() + 0.4).sin();
    return Eigen::VectorXd(0.3 * wave * (load - load.mean()));
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q5)*tau5") != std::string::npos, formula.c_str());
}

void a_wave_whose_size_follows_the_speed_is_a_law() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, [](const simulation::Simulation& at) {
    const Eigen::ArrayXd speed = at.velocity.col(4).array();
    return Eigen::VectorXd(60 * (50 * at.q.col(4).array() + 0.4).sin() * speed /
                           speed.abs().maxCoeff());
  }));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q5)*v5") != std::string::npos, formula.c_str());
}

/// A torque that follows the joint's load late, by 2 s.
Eigen::VectorXd late_load(const simulation::Simulation& at) {
  Eigen::VectorXd late = -at.prediction.dynamic_load.col(4);
  constexpr double kKept = 0.995;  // from one row to the next
  for (Eigen::Index row = 1; row < late.size(); ++row) {
    late[row] = kKept * late[row - 1] + (1 - kKept) * late[row];
  }
  return 0.5 * late;
}

void what_a_joint_carried_before_is_found_by_a_lag() {
  const DrivenRobot robot;
  const Finding found = only_law(observed(robot, 5, late_load));
  const std::string formula = found.chosen.hypothesis.law->written->formula;
  TEST_ASSERT_TRUE_MESSAGE(formula.rfind("a*lag(tau5, T)", 0) == 0, formula.c_str());
}

void what_a_joint_carried_before_the_recording_is_no_constant() {
  const DrivenRobot robot;
  const Observations observations = robot.observed_in_parts(with(robot, 5, late_load));
  const Finding found = only_law(observations);
  const Hypothesis& law = found.chosen.hypothesis;
  TEST_ASSERT_EQUAL_STRING("a*lag(tau5, T)", law.law->written->formula.c_str());
  TEST_ASSERT_EQUAL_STRING("T", law.parameters[1].name.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 2.0, found.chosen.values[1]);
  // Where it began says nothing of the machine.
  TEST_ASSERT_TRUE(law.parameters.back().is_of_recording);
  for (const auto& told : estimates(observations, found.chosen, found.covariance)) {
    TEST_ASSERT_TRUE(told.name != law.parameters.back().name);
  }
}

/// Friction that builds up with the angle after every reversal, as a play's other side.
Eigen::VectorXd held_back(const simulation::Simulation& at) {
  constexpr double kGap = 0.06;  // rad
  Eigen::VectorXd torque(at.q.rows());
  double follows = at.q(0, 4);
  for (Eigen::Index row = 0; row < torque.size(); ++row) {
    follows = std::clamp(follows, at.q(row, 4) - kGap / 2, at.q(row, 4) + kGap / 2);
    torque[row] = 800 * (at.q(row, 4) - follows);
  }
  return torque;
}

void a_loop_is_a_law_where_its_effect_is_left_out() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, held_back);
  TEST_ASSERT_TRUE(laws_in(observations).findings.empty());
  grammar::Budget budget(600);
  const Choice found = laws_in(observations, &budget, "friction_hysteresis");
  TEST_ASSERT_EQUAL_UINT64(1, found.findings.size());
  const auto& law = found.findings.front().chosen;
  TEST_ASSERT_EQUAL_STRING("a*(q5 - play(q5, w))", law.hypothesis.law->written->formula.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(20, 800, law.values[0]);
  TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.06, law.values[1]);
}

void a_search_without_time_says_so_and_finds_nothing() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(40 * (3 * at.q.col(3).array()).sin());
  });
  grammar::Budget budget(0);
  TEST_ASSERT_TRUE(laws_in(observations, &budget).findings.empty());
  TEST_ASSERT_TRUE(budget.has_stopped());
}

void a_picture_that_fails_leaves_a_sentence() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(40 * (3 * at.q.col(3).array()).sin());
  });
  flexcomp::diagnosis::Diagnosis diagnosis;
  diagnosis.choice = laws_in(observations);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  const std::string html = law_pictures(observations, diagnosis);
  ::setenv("PATH", path.c_str(), 1);
  TEST_ASSERT_TRUE(html.find("No picture of a*sin(3*q4)") != std::string::npos);
  TEST_ASSERT_TRUE(law_pictures(observations, diagnosis).find("<svg") != std::string::npos);
}

void what_the_catalogue_has_keeps_its_name() {
  const DrivenRobot robot;
  const Observations observations = observed(robot, 5, [](const simulation::Simulation& at) {
    return Eigen::VectorXd(30 * at.velocity.col(4));
  });
  TEST_ASSERT_TRUE(laws_in(observations).findings.empty());
}

void an_effect_has_a_name_for_shapes_that_are_composed_only() {
  int known = 0;
  for (const auto& [effect, search] : flexcomp::diagnosis::searches()) {
    for (const flexcomp::diagnosis::Known& law : search.known) {
      for (const std::string& shape : law.shapes) {
        const bool is_composed =
            std::any_of(grammar::shapes().begin(), grammar::shapes().end(),
                        [&](const grammar::Shape& each) { return shape == each.name; });
        TEST_ASSERT_TRUE_MESSAGE(is_composed, (effect + " knows no shape " + shape).c_str());
        ++known;
      }
    }
  }
  TEST_ASSERT_GREATER_THAN(0, known);
}

void a_tone_is_told_in_time() {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  const auto tone = [](double time) { return 40 * std::sin(2 * std::acos(-1.0) * 1.7 * time); };
  flexcomp::test::add_torque(2, tone, &truth);
  const Choice choice = laws_in(robot.observed(truth));
  TEST_ASSERT_EQUAL_UINT64(1, choice.findings.size());
  const auto& found = choice.findings.front().chosen;
  TEST_ASSERT_EQUAL_STRING("sensor tau", found.hypothesis.law->written->place.c_str());
  TEST_ASSERT_EQUAL_STRING("a*sin(k*t) + b*cos(k*t)",
                           found.hypothesis.law->written->formula.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(1e-3, 2 * std::acos(-1.0) * 1.7, found.values[2]);
}

void what_a_fit_makes_up_has_next_to_no_gain() {
  // A course of square 100 that leans on what is fitted by nothing, by half of its square, and
  // whole, where only rounding is left of it.
  const auto gain_of = [](double shown) {
    const grammar::Normal normal =
        grammar::beside(Eigen::MatrixXd::Constant(1, 1, 100.0),
                        Eigen::MatrixXd::Constant(1, 1, shown), Eigen::VectorXd::Constant(1, 10.0));
    return normal.gain(normal.amplitude());
  };
  TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1, gain_of(0));
  TEST_ASSERT_DOUBLE_WITHIN(1e-3, 2, gain_of(std::sqrt(50)));
  TEST_ASSERT_TRUE(gain_of(std::sqrt(100 - 1e-9)) < 1.01e4);  // of its square a ten thousandth
}

void gains_are_told_where_nothing_was_fitted() {
  // Four stretches whose least squares alone are 1, 1, 1 and 3: whatever the halves, what two of
  // them say gains on the others what the sums over these give by hand.
  std::vector<grammar::Normal> stretches;
  for (const double amplitude : {1.0, 1.0, 1.0, 3.0}) {
    stretches.push_back(
        {Eigen::MatrixXd::Constant(1, 1, 2.0), Eigen::VectorXd::Constant(1, 2.0 * amplitude)});
  }
  for (const double gain : grammar::unseen_gains(stretches)) {
    // Halves {1, 1} and {1, 3}: from 1 to (1 + 3) / 2 = 2, or from 2 to 1.
    const bool is_expected = std::abs(gain - (2 * 8 - 4)) < 1e-6 || std::abs(gain - 0) < 1e-6;
    TEST_ASSERT_TRUE(is_expected);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(noise_alone_has_no_law);
  RUN_TEST(a_hose_that_another_joint_pulls_is_a_wave_of_its_angle);
  RUN_TEST(friction_that_another_joints_angle_raises_is_followed);
  RUN_TEST(friction_of_a_gear_that_drives_follows_its_power);
  RUN_TEST(a_wave_that_another_joint_turns_round_is_one_law);
  RUN_TEST(a_stop_that_few_stretches_touch_is_weighed);
  RUN_TEST(a_law_that_hardly_bends_is_weighed_against_the_line);
  RUN_TEST(a_wave_is_seen_though_its_size_is_nothing_on_average);
  RUN_TEST(a_wave_whose_size_follows_the_load_is_a_law);
  RUN_TEST(a_wave_whose_size_follows_the_speed_is_a_law);
  RUN_TEST(what_a_joint_carried_before_is_found_by_a_lag);
  RUN_TEST(what_a_joint_carried_before_the_recording_is_no_constant);
  RUN_TEST(a_loop_is_a_law_where_its_effect_is_left_out);
  RUN_TEST(a_search_without_time_says_so_and_finds_nothing);
  RUN_TEST(a_picture_that_fails_leaves_a_sentence);
  RUN_TEST(what_the_catalogue_has_keeps_its_name);
  RUN_TEST(an_effect_has_a_name_for_shapes_that_are_composed_only);
  RUN_TEST(a_tone_is_told_in_time);
  RUN_TEST(what_a_fit_makes_up_has_next_to_no_gain);
  RUN_TEST(gains_are_told_where_nothing_was_fitted);
  return UNITY_END();
}
