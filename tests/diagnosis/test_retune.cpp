// The model's own numbers in the place of physics that no effect of the catalogue has.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/refit.hpp"
#include "diagnosis/retune.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::diagnosis::Chosen;
using flexcomp::diagnosis::Dictionary;
using flexcomp::diagnosis::Fit;
using flexcomp::diagnosis::Hypothesis;
using flexcomp::diagnosis::Observations;
using flexcomp::test::SwingingRobot;

namespace {

constexpr double kTorqueNoise = 2;  // N·m
constexpr double kFriction = 40;    // N·m

/// Errors of the torques (n × 6), of one joint (n), N·m.
Eigen::MatrixXd at_joint(int joint, const Eigen::VectorXd& error) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(error.size(), 6);
  all.col(joint - 1) = error;
  return all;
}

/// The swinging robot with its torques besides, noisy and in error (n × 6, N·m).
Observations with_torques(const SwingingRobot& swinging, const Eigen::MatrixXd& error) {
  recording::Recording shown = swinging.recording;
  shown.tau = recording::Samples::Zero(shown.size(), 6);
  simulation::Preparation preparation;
  const simulation::Scene scene = simulation::prepare(shown, shown.size(), &preparation);
  simulation::Machine machine = effects::machine_of(swinging.robot, {scene});
  *shown.tau = simulate(machine, scene).prediction.channel[simulation::joint_torque];
  *shown.tau += error;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, kTorqueNoise);
  for (Eigen::Index row = 0; row < shown.size(); ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      (*shown.tau)(row, column) += noise(random);
    }
  }
  std::vector<simulation::Scene> scenes = {simulation::prepare(shown, shown.size(), &preparation)};
  return Observations(std::move(machine), std::move(scenes), 0);
}

/// Beside findings, by default none.
Fit retuned(const Observations& observations, const std::vector<Hypothesis>& hypotheses,
            const std::vector<Chosen>& findings = {}) {
  constexpr int kSteps = 10;
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  return retune(observations, fit(observations, findings, kSteps), hypotheses, dictionary);
}

/// Friction (N·m) of joint 2 that joint 1 makes larger and smaller: on average it is dry friction.
Eigen::VectorXd varying_friction(const SwingingRobot& swinging) {
  const Eigen::ArrayXd varying = 1 + 0.4 * (20 * swinging.scene.q.col(0).array()).sin();
  return kFriction * varying * swinging.scene.velocity.col(1).array().sign();
}

double held_out(const Observations& observations, const Eigen::VectorXd& values) {
  return observations.rms(values, simulation::joint_torque, true);
}

void friction_that_varies_is_stood_in_for_by_its_mean() {
  const SwingingRobot swinging(1);
  const Observations observations = with_torques(swinging, at_joint(2, varying_friction(swinging)));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Fit fit = retuned(observations, hypotheses);
  TEST_ASSERT_EQUAL_UINT64(1, fit.chosen.size());
  TEST_ASSERT_EQUAL_STRING("coulomb_friction", fit.chosen.front().hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL_INT(2, fit.chosen.front().hypothesis.joint);
  TEST_ASSERT_DOUBLE_WITHIN(0.1 * kFriction, kFriction, fit.chosen.front().values.front());
  // The variation about the mean is left, and the noise of six joints.
  const double noise = 6 * kTorqueNoise * kTorqueNoise;
  const double left = 0.08 * kFriction * kFriction + noise;
  const double whole = 1.08 * kFriction * kFriction + noise;
  TEST_ASSERT_DOUBLE_WITHIN(
      0.05, std::sqrt(left / whole),
      held_out(observations, fit.remainder) / held_out(observations, observations.residual));
}

void numbers_stand_in_for_what_findings_leave() {
  constexpr double kOffset = 60;  // N·m
  const SwingingRobot swinging(4);
  const Observations observations =
      with_torques(swinging, at_joint(5, Eigen::VectorXd::Constant(swinging.rows(), kOffset)) +
                                 at_joint(2, varying_friction(swinging)));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const auto offset = std::find_if(
      hypotheses.begin(), hypotheses.end(),
      [](const Hypothesis& each) { return each.effect() == "torque_offset" && each.joint == 5; });
  const Fit fit = retuned(observations, hypotheses, {{*offset, {0}}});
  TEST_ASSERT_EQUAL_UINT64(2, fit.chosen.size());
  TEST_ASSERT_EQUAL_STRING("torque_offset", fit.chosen.front().hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(1, kOffset, fit.chosen.front().values.front());
  TEST_ASSERT_EQUAL_STRING("coulomb_friction", fit.chosen.back().hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.1 * kFriction, kFriction, fit.chosen.back().values.front());
}

void a_model_that_agrees_keeps_its_numbers() {
  const SwingingRobot swinging(2);
  const Observations observations =
      with_torques(swinging, Eigen::MatrixXd::Zero(swinging.rows(), 6));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  TEST_ASSERT_TRUE(retuned(observations, hypotheses).chosen.empty());
}

/// A hum that goes with no speed and no load: friction fitted to it would be chance.
void what_no_number_can_stand_in_for_leaves_them_as_they_are() {
  const SwingingRobot swinging(3);
  const Eigen::ArrayXd time = swinging.recording.time.array();
  const Observations observations =
      with_torques(swinging, at_joint(2, kFriction * (2 * M_PI * 3.1 * time).sin()));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  TEST_ASSERT_TRUE(retuned(observations, hypotheses).chosen.empty());
}

/// Friction torques (n × 6, N·m) of the first five joints, the motor of the fifth coupled to the
/// fourth by one turn: by hand, as every joint's power is that of the motors.
Eigen::MatrixXd coupled_friction(const SwingingRobot& swinging) {
  const Eigen::MatrixXd& speed = swinging.scene.velocity;
  Eigen::MatrixXd torque = Eigen::MatrixXd::Zero(speed.rows(), 6);
  for (Eigen::Index motor = 0; motor < 5; ++motor) {
    const double dry = 20 + 5 * static_cast<double>(motor);       // N·m
    const double viscous = 50 - 10 * static_cast<double>(motor);  // N·m·s/rad
    Eigen::VectorXd own = speed.col(motor);
    if (motor == 4) {
      own += speed.col(3);
    }
    const Eigen::VectorXd friction = dry * own.array().sign().matrix() + viscous * own;
    torque.col(motor) += friction;
    if (motor == 4) {
      torque.col(3) += friction;
    }
  }
  return torque;
}

/// No single cause accounts for much of it; all of them do, each by its own evidence.
void friction_everywhere_and_a_coupled_drive_are_found_together() {
  const SwingingRobot swinging(5);
  Observations observations = with_torques(swinging, coupled_friction(swinging));
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const diagnosis::Diagnosis found =
      diagnose(&observations, hypotheses, flexcomp::test::quiet_settings(0));
  std::set<int> with_friction;
  bool is_coupled = false;
  for (const diagnosis::Finding& finding : found.choice.findings) {
    const Hypothesis& hypothesis = finding.chosen.hypothesis;
    if (hypothesis.effect() == "coulomb_friction" || hypothesis.effect() == "viscous_friction") {
      with_friction.insert(hypothesis.joint);
    }
    if (hypothesis.effect() == "transmission") {
      TEST_ASSERT_EQUAL_INT(5, hypothesis.joint);
      TEST_ASSERT_DOUBLE_WITHIN(0.05, 1, finding.chosen.values.front());
      is_coupled = true;
    }
  }
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_TRUE(is_coupled);
  TEST_ASSERT_TRUE(with_friction == (std::set<int>{1, 2, 3, 4, 5}));
  // As near as whoever knows what was put in: all that is left is the noise.
  TEST_ASSERT_TRUE(held_out(observations, found.updated().remainder) < 1.1 * kTorqueNoise);
}

/// A load that nobody told the model of, on a machine whose motors have dry friction and ripple
/// besides, in part as no effect has them. The findings are so many that all numbers are fitted
/// together: masses of the last links do what the load does, and would share it.
void a_load_keeps_its_name_among_many_numbers() {
  constexpr double kMass = 60;     // kg
  constexpr double kDry = 8;       // N·m
  constexpr double kRippling = 6;  // N·m
  const test::DrivenRobot driven;
  simulation::Machine truth = driven.machine();
  truth.robot.elastic.payload_mass = kMass;
  truth.robot.elastic.payload_center = {0.1, 0.15, 0.2};
  truth.terms.push_back(
      {simulation::Term::output, [=](const simulation::Scene&, const simulation::Simulation& at,
                                     simulation::Prediction* prediction) {
         const Eigen::ArrayXXd angle = at.q.array();
         prediction->channel[simulation::joint_torque].array() +=
             kDry * at.velocity.array().sign() * (1 + 0.5 * (9 * angle).sin()) +
             kRippling * (31 * angle).sin() * (7 * angle).cos();
       }});
  Observations observations = driven.observed(truth);
  const diagnosis::Diagnosis found =
      diagnose(&observations, all_hypotheses(observations), flexcomp::test::quiet_settings(0));
  TEST_ASSERT_FALSE(found.choice.findings.empty());
  const Chosen& first = found.choice.findings.front().chosen;
  TEST_ASSERT_EQUAL_STRING("payload", first.hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kMass, kMass, first.values.front());
}

/// Bodies that cannot be predict as well as a finding may be what it is: the finding says more.
void findings_stay_where_only_bodies_that_cannot_be_predict_as_well() {
  const SwingingRobot swinging(5);
  const Observations observations =
      with_torques(swinging, at_joint(2, Eigen::VectorXd::Constant(swinging.recording.size(), 3)));
  Fit alone = fit(observations, {}, 0);
  const Hypothesis body(effects::find_law("link_mass", "mounted"), 2, swinging.robot);
  alone.chosen = {{body, {0, 0, 0, 0}}};
  const Fit beside = alone;
  TEST_ASSERT_FALSE(is_better_beside(observations, alone, beside));
  alone.chosen.front().hypothesis.is_regression = true;
  TEST_ASSERT_TRUE(is_better_beside(observations, alone, beside));
  Fit better = alone;
  better.remainder *= 0.9;
  TEST_ASSERT_FALSE(is_better_beside(observations, better, beside));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(friction_that_varies_is_stood_in_for_by_its_mean);
  RUN_TEST(numbers_stand_in_for_what_findings_leave);
  RUN_TEST(a_model_that_agrees_keeps_its_numbers);
  RUN_TEST(what_no_number_can_stand_in_for_leaves_them_as_they_are);
  RUN_TEST(findings_stay_where_only_bodies_that_cannot_be_predict_as_well);
  RUN_TEST(a_load_keeps_its_name_among_many_numbers);
  RUN_TEST(friction_everywhere_and_a_coupled_drive_are_found_together);
  return UNITY_END();
}
