// Laws that nobody listed within a whole diagnosis: beside effects of the catalogue, in their
// place, and at joints that carry little.
#include <random>
#include <utility>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/output/sentences.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Diagnosis;
using flexcomp::diagnosis::Finding;
using flexcomp::diagnosis::Observations;
using flexcomp::test::DrivenRobot;
namespace diagnosis = flexcomp::diagnosis;
namespace simulation = flexcomp::simulation;

namespace {

/// Adds torques (N·m, a column a joint) by what the machine does.
using Torques = std::function<Eigen::MatrixXd(const simulation::Simulation& at)>;

simulation::Term adding(Torques torques) {
  return {simulation::Term::output, [=](const simulation::Scene&, const simulation::Simulation& at,
                                        simulation::Prediction* prediction) {
            prediction->channel[simulation::joint_torque] += torques(at);
          }};
}

Diagnosis diagnosed(Observations* observations) {
  constexpr double kLawSeconds = 600;  // no search ends for want of time
  return flexcomp::test::diagnosed(observations, kLawSeconds);
}

/// What is found of a robot whose drives have these torques besides.
Diagnosis diagnosed_with(Torques torques) {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  truth.terms.push_back(adding(std::move(torques)));
  Observations observations = robot.observed(truth);
  return diagnosed(&observations);
}

/// The formula of the only law; empty unless there is one, at this joint.
std::string law_at(const Diagnosis& found, int joint) {
  std::string formula;
  for (const Finding& finding : found.choice.findings) {
    const diagnosis::Hypothesis& hypothesis = finding.chosen.hypothesis;
    if (hypothesis.is_law()) {
      formula =
          formula.empty() && hypothesis.joint == joint ? hypothesis.law->written->formula : "";
    }
  }
  return formula;
}

bool has(const Diagnosis& found, const std::string& effect, int joint) {
  return std::any_of(
      found.choice.findings.begin(), found.choice.findings.end(), [&](const Finding& each) {
        return each.chosen.hypothesis.effect() == effect && each.chosen.hypothesis.joint == joint;
      });
}

Eigen::VectorXd hose(const simulation::Simulation& at) {
  return 30 * (3 * at.q.col(3).array() + 0.7).sin();
}

/// What a law takes away is a thousandth of the torques' noise in all, and five times its own
/// joint's.
void a_law_at_a_quiet_joint_is_kept_beside_a_loud_one() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-2100, 2100);
    torques.col(0) = torques.col(0).unaryExpr([&](double) { return noise(random); });
    torques.col(4) = hose(at);
    return torques;
  });
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_STRING("a*sin(3*q4) + b*cos(3*q4)", law_at(found, 5).c_str());
}

void a_law_is_found_beside_an_effect() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(1) = 25 * at.velocity.col(1).cwiseSign();
    torques.col(4) = hose(at);
    return torques;
  });
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_UINT64(2, found.choice.findings.size());
  TEST_ASSERT_TRUE(has(found, "coulomb_friction", 2));
  TEST_ASSERT_EQUAL_STRING("a*sin(3*q4) + b*cos(3*q4)", law_at(found, 5).c_str());
}

/// A course of another signal times the direction of motion comes nearer to both at once than dry
/// friction by itself.
void friction_and_a_stop_of_one_joint_are_told_apart() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    const Eigen::ArrayXd angle = at.q.col(4).array();
    const double stop = angle.minCoeff() + 0.7 * (angle.maxCoeff() - angle.minCoeff());
    torques.col(4) = 60 * at.velocity.col(4).array().sign() + 900 * (angle - stop).max(0);
    return torques;
  });
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_TRUE(has(found, "coulomb_friction", 5));
  const std::string formula = law_at(found, 5);
  TEST_ASSERT_TRUE_MESSAGE(formula.find("*step(q5 - d)") != std::string::npos, formula.c_str());
}

/// Ripple of the catalogue accounts for most of a ripple that another joint swells a little, and is
/// chosen while a load hides the rest.
void an_effect_that_stands_for_a_law_gives_way_to_it() {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  truth.robot.elastic.payload_mass += 30;
  truth.terms.push_back(adding([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(3) = 120 * (13 * at.q.col(3).array()).sin() * (at.q.col(1).array() + 0.4).cos();
    return torques;
  }));
  Observations observations = robot.observed(truth);
  const Diagnosis found = diagnosed(&observations);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_TRUE(has(found, "payload", 0));
  const std::string formula = law_at(found, 4);
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q4)*") != std::string::npos, formula.c_str());
}

/// Ripple that another joint swells so little that ripple of the catalogue leaves hardly more than
/// noise.
void an_effect_that_hides_a_law_gives_way_to_it() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(3) = 24 * (13 * at.q.col(3).array()).sin() * (1 + 0.4 * at.q.col(0).array());
    return torques;
  });
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  const std::string formula = law_at(found, 4);
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q4)*q1") != std::string::npos, formula.c_str());
}

/// Friction of several hundred times the noise bends by a little of it: a real machine's always
/// does.
void an_effect_stays_where_a_law_gains_next_to_nothing() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(4) = 16000 * (at.velocity.col(4).array() / 8).tanh();
    return torques;
  });
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  TEST_ASSERT_TRUE(has(found, "viscous_friction", 5));
}

/// A zero of thirty times the noise, and a little that wanes.
void the_constant_of_a_law_keeps_its_name() {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  flexcomp::test::add_torque(
      5, [](double time) { return 60 + 12 * std::exp(-time / 5); }, &truth);
  Observations observations = robot.observed(truth);
  const Diagnosis found = diagnosed(&observations);
  TEST_ASSERT_EQUAL_UINT64(2, found.choice.findings.size());
  TEST_ASSERT_TRUE(has(found, "torque_offset", 5));
  TEST_ASSERT_EQUAL_STRING("a*exp(-t/T)", law_at(found, 5).c_str());
}

/// Ripple that another joint turns round, beside a zero at a third one: while that is off, ripple
/// of the catalogue is hardly worse than the law.
void an_effect_gives_way_to_a_law_that_another_joint_hid() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(3) = 24 * (13 * at.q.col(3).array()).sin() * (1 + 0.4 * at.q.col(0).array());
    torques.col(4).setConstant(10);
    return torques;
  });
  TEST_ASSERT_EQUAL_UINT64(2, found.choice.findings.size());
  TEST_ASSERT_TRUE(has(found, "torque_offset", 5));
  const std::string formula = law_at(found, 4);
  TEST_ASSERT_TRUE_MESSAGE(formula.find("sin(k*q4)*") != std::string::npos, formula.c_str());
}

/// A stop near the end of a joint's travel, which a balancer imitates by twice as many numbers.
void a_law_is_told_where_a_rare_effect_needs_more_numbers() {
  const Diagnosis found = diagnosed_with([](const simulation::Simulation& at) {
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(at.q.rows(), 6);
    torques.col(1) = 60 * (-1.1 - at.q.col(1).array()).max(0);
    return torques;
  });
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  TEST_ASSERT_EQUAL_STRING("a*(d - q2)*step(d - q2)", law_at(found, 2).c_str());
}

/// The torque of the third joint with a tone of 2 Hz, in a recording of its own.
simulation::Scene humming(const DrivenRobot& robot, double phase) {
  simulation::Machine truth = robot.machine();
  const auto hum = [=](double time) {
    return 6 * DrivenRobot::kNoise * std::sin(4 * M_PI * time + phase);
  };
  flexcomp::test::add_torque(3, hum, &truth);
  return robot.observed(truth).scenes.front();
}

/// Two recordings have twice as many rows in the same time, and are sampled no faster for it.
void a_tone_is_told_where_another_recording_has_another_phase() {
  const DrivenRobot robot;
  Observations observations(robot.machine(), {humming(robot, 0.3), humming(robot, 2.2)}, 1);
  const Diagnosis found = diagnosed(&observations);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_STRING("a*sin(k*t) + b*cos(k*t)", law_at(found, 3).c_str());
  const diagnosis::Chosen& tone = found.choice.findings.front().chosen;
  for (std::size_t i = 0; i < tone.values.size(); ++i) {
    if (tone.hypothesis.parameters[i].name == "k") {
      TEST_ASSERT_DOUBLE_WITHIN(0.01 * 4 * M_PI, 4 * M_PI, tone.values[i]);
    }
  }
  TEST_ASSERT_TRUE(found.updated().placed(observations).empty());  // a third has another phase
  const std::string said = diagnosis::statement(observations, found, 0);
  TEST_ASSERT_TRUE(said.find("does not have it") != std::string::npos);
}

void a_tone_goes_on_in_the_recording_that_it_was_found_in() {
  const DrivenRobot robot;
  Observations observations(robot.machine(), {humming(robot, 0.3)}, 0);
  const Diagnosis found = diagnosed(&observations);
  TEST_ASSERT_EQUAL_STRING("a*sin(k*t) + b*cos(k*t)", law_at(found, 3).c_str());
  TEST_ASSERT_EQUAL_UINT64(1, found.updated().placed(observations).size());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_law_at_a_quiet_joint_is_kept_beside_a_loud_one);
  RUN_TEST(a_law_is_found_beside_an_effect);
  RUN_TEST(friction_and_a_stop_of_one_joint_are_told_apart);
  RUN_TEST(an_effect_that_stands_for_a_law_gives_way_to_it);
  RUN_TEST(an_effect_that_hides_a_law_gives_way_to_it);
  RUN_TEST(an_effect_stays_where_a_law_gains_next_to_nothing);
  RUN_TEST(the_constant_of_a_law_keeps_its_name);
  RUN_TEST(an_effect_gives_way_to_a_law_that_another_joint_hid);
  RUN_TEST(a_law_is_told_where_a_rare_effect_needs_more_numbers);
  RUN_TEST(a_tone_is_told_where_another_recording_has_another_phase);
  RUN_TEST(a_tone_goes_on_in_the_recording_that_it_was_found_in);
  return UNITY_END();
}
