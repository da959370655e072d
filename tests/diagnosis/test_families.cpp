// A machine's families of numbers fitted at once: its friction as it is, and bodies that can be.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/families/families.hpp"
#include "diagnosis/families/latecomers.hpp"
#include "diagnosis/families/possible_bodies.hpp"
#include "diagnosis/families/settle.hpp"
#include "diagnosis/gains.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Chosen;
using diagnosis::Dictionary;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::DrivenRobot;

namespace {

constexpr Eigen::Index kMoving = 5;  // joints; the sixth stands

double dry(std::size_t joint) { return 40 + 10 * static_cast<double>(joint); }       // N·m
double viscous(std::size_t joint) { return 120 - 10 * static_cast<double>(joint); }  // N·m·s/rad

const DrivenRobot& robot() {
  static const DrivenRobot driven;
  return driven;
}

Hypothesis found(const std::vector<Hypothesis>& hypotheses, const char* effect, const char* form,
                 int joint) {
  return *std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& each) {
    return each.effect() == effect && each.law->form == form && each.joint == joint;
  });
}

Fit fitted(const Observations& observations) {
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  return fit_families(observations, fit(observations, {}, 0), hypotheses, dictionary).fit;
}

void friction_of_all_joints_is_told_and_nothing_else_beside_it() {
  simulation::Machine truth = robot().machine();
  for (std::size_t i = 0; i < kMoving; ++i) {
    truth.robot.dynamics[i].coulomb += dry(i);
    truth.robot.dynamics[i].viscous += viscous(i);
  }
  const Observations observations = robot().observed(truth);
  const Fit fit = fitted(observations);
  for (std::size_t i = 0; i < kMoving; ++i) {
    const model::JointDynamics& model = robot().robot.dynamics[i];
    const model::JointDynamics& found = fit.machine.robot.dynamics[i];
    TEST_ASSERT_DOUBLE_WITHIN(0.04 * dry(i), dry(i), found.coulomb - model.coulomb);
    TEST_ASSERT_DOUBLE_WITHIN(0.06 * viscous(i), viscous(i), found.viscous - model.viscous);
  }
  // Whatever else stays, since it predicts no worse, is not told from nothing.
  constexpr double kTold = 4;  // standard deviations
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    const std::string effect = fit.chosen[i].hypothesis.effect();
    if (effect == "coulomb_friction" || effect == "viscous_friction") {
      continue;
    }
    const Eigen::MatrixXd covariance = fit.covariance_of(i);
    for (std::size_t k = 0; k < fit.chosen[i].values.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(kTold * std::sqrt(covariance(at, at)) + 1e-12, 0,
                                        fit.chosen[i].values[k], effect.c_str());
    }
  }
}

/// Torques of a machine whose masses, friction and torque constants are all off: these multiply
/// each other, so that the model's own derivatives do not lead to them. With all gains larger and
/// all else smaller, torques are the same: what is told of a gain must be as uncertain as that.
void gains_are_told_beside_what_they_multiply() {
  constexpr double kGains[] = {0.2, -0.15, 0.25, 0, 0};
  constexpr double kSure = 3;  // standard deviations
  simulation::Machine truth = robot().machine();
  for (std::size_t i = 0; i < kMoving; ++i) {
    truth.robot.dynamics[i].coulomb += 3 * dry(i);
    truth.robot.dynamics[i].viscous += 3 * viscous(i);
  }
  for (const int joint : {2, 3}) {
    effects::find_law("link_mass", "body")
        ->apply({0.3 * robot().robot.elastic.joints[static_cast<std::size_t>(joint - 1)].mass},
                joint, &truth);
  }
  for (int joint = 1; joint <= 3; ++joint) {
    effects::find_law("torque_gain", "")->apply({kGains[joint - 1]}, joint, &truth);
  }
  const Observations observations = robot().observed(truth);
  const Fit fit = fitted(observations);
  const double noise =
      observations.rms(Eigen::VectorXd::Ones(observations.size()), simulation::joint_torque, true);
  const double left = observations.rms(fit.remainder, simulation::joint_torque, true);
  TEST_ASSERT_TRUE(left < 1.2 * noise);
  int told = 0;
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    const Hypothesis& each = fit.chosen[i].hypothesis;
    if (each.traits().is_gain && each.joint <= kMoving) {
      const double deviation = std::sqrt(fit.covariance_of(i)(0, 0));
      TEST_ASSERT_DOUBLE_WITHIN(kSure * deviation, kGains[each.joint - 1],
                                fit.chosen[i].values.front());
      ++told;
    }
  }
  TEST_ASSERT_EQUAL(kMoving, told);
}

/// A dictionary's columns are of the model, whose torques no gain multiplies: as derivatives of a
/// machine with gains they must be multiplied.
void what_a_gain_multiplies_has_derivatives_that_it_multiplies() {
  const Observations observations = robot().observed(robot().machine());
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Hypothesis gain = found(hypotheses, "torque_gain", "", 2);
  const Hypothesis rotor = found(hypotheses, "rotor_inertia", "", 2);
  const Hypothesis other = found(hypotheses, "rotor_inertia", "", 3);
  Dictionary dictionary(observations, {gain, rotor, other}, [](std::size_t, std::size_t) {});
  const std::vector<Chosen> chosen = {{gain, {0.3}}, {rotor, {0}}, {other, {0}}};
  const Eigen::MatrixXd exact = fit(observations, chosen, 0).derivative;
  const Eigen::MatrixXd known = fit(observations, chosen, 0, &dictionary).derivative;
  TEST_ASSERT_TRUE((known - exact).norm() < 1e-6 * exact.norm());
  // Those of a dictionary about such a machine are multiplied already.
  const Fit about = fit(observations, chosen, 0);
  Dictionary own(observations, {gain, rotor, other}, about.machine,
                 [](std::size_t, std::size_t) {});
  own.gains = gains_of(chosen, robot().robot.joints());
  const Eigen::MatrixXd again = fit(observations, chosen, 0, &own).derivative;
  TEST_ASSERT_TRUE((again - exact).norm() < 1e-6 * exact.norm());
}

/// Joints at which an effect is among those that were chosen.
std::vector<int> joints_with(const char* effect, const std::vector<Chosen>& chosen) {
  std::vector<int> joints;
  for (const Chosen& each : chosen) {
    if (each.hypothesis.effect() == effect) {
      joints.push_back(each.hypothesis.joint);
    }
  }
  return joints;
}

void friction_that_falls_with_speed_joins_the_family_at_its_joint() {
  constexpr int kJoint = 2;
  simulation::Machine truth = robot().machine();
  for (std::size_t i = 0; i < kMoving; ++i) {
    truth.robot.dynamics[i].coulomb += dry(i);
    truth.robot.dynamics[i].viscous += viscous(i);
  }
  effects::find_law("stribeck_friction", "")->apply({60, 0.02}, kJoint, &truth);
  const Observations observations = robot().observed(truth);
  const Fit fit = fitted(observations);
  const std::vector<int> joints = joints_with("stribeck_friction", fit.chosen);
  TEST_ASSERT_EQUAL(1, joints.size());
  TEST_ASSERT_EQUAL(kJoint, joints.front());
}

/// Friction that falls at low speed and rises at high looks dry, and neither of its parts shows
/// much without the other.
void friction_that_falls_and_rises_is_proposed_whole() {
  constexpr int kJoint = 2;
  simulation::Machine truth = robot().machine();
  truth.robot.dynamics[kJoint - 1].coulomb += 60;
  truth.robot.dynamics[kJoint - 1].viscous += 150;
  effects::find_law("stribeck_friction", "")->apply({40, 0.1}, kJoint, &truth);
  const Observations observations = robot().observed(truth);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  const Hypothesis dry = found(hypotheses, "coulomb_friction", "", kJoint);
  const Fit as_dry = fit(observations, {{dry, {60}}}, 10);
  const std::vector<Chosen> late = latecomers(observations, as_dry, dictionary);
  TEST_ASSERT_EQUAL(1, joints_with("stribeck_friction", late).size());
  TEST_ASSERT_EQUAL(1, joints_with("viscous_friction", late).size());
  TEST_ASSERT_EQUAL(kJoint, joints_with("stribeck_friction", late).front());
  TEST_ASSERT_EQUAL(kJoint, joints_with("viscous_friction", late).front());
}

/// What a joint's friction leaves unexplained may hide the friction of a smaller joint.
void friction_that_hides_behind_a_latecomer_joins_after_it() {
  constexpr double kLarge = 400, kSmall = 16;  // N·m
  simulation::Machine truth = robot().machine();
  for (std::size_t i = 0; i < kMoving; ++i) {
    truth.robot.dynamics[i].coulomb += dry(i);
    truth.robot.dynamics[i].viscous += viscous(i);
  }
  const effects::LawPointer stribeck = effects::find_law("stribeck_friction", "");
  stribeck->apply({kLarge, 0.03}, 2, &truth);
  stribeck->apply({kSmall, 0.03}, 4, &truth);
  const std::vector<int> joints =
      joints_with("stribeck_friction", fitted(robot().observed(truth)).chosen);
  TEST_ASSERT_EQUAL(2, joints.size());
  TEST_ASSERT_EQUAL(2, joints.front());
  TEST_ASSERT_EQUAL(4, joints.back());
}

constexpr int kBody = 3;  // the link whose body cannot be

/// A machine whose third link would have its centre of mass far outside, as if something else were
/// left out, and what is fitted to it: mass and first moment on that link, held within an edge.
struct ImpossibleBody {
  double far = 3 * robot().robot.elastic.joints[kBody - 1].mass;  // kg·m
  effects::LawPointer law = effects::find_law("link_mass", "mounted");
  Observations observations = robot().observed(truth());

  simulation::Machine truth() const {
    simulation::Machine machine = robot().machine();
    law->apply({0, 0, far, 0}, kBody, &machine);
    return machine;
  }

  Fit fitted(double edge) const {
    Hypothesis mounted(law, kBody, robot().robot);
    mounted.set_bounds(
        {{-1, 1, 0.1}, {-2 * far, 2 * far, 1}, {-2 * far, 2 * far, 1}, {-1, 1, 0.1}});
    mounted.edge = edge;
    return fit(observations, {{mounted, {0, 0, 0, 0}}}, 20);
  }

  double excess(const simulation::Machine& machine) const {
    return law->excess(robot().robot, machine.robot, effects::size_of(robot().robot), kBody, 0)
        .norm();
  }
};

void a_body_with_an_edge_is_held_within_what_can_be() {
  const ImpossibleBody body;
  const Fit held = body.fitted(1e-4);
  TEST_ASSERT_TRUE(held.chosen.front().values[2] > 0.05 * body.far);
  TEST_ASSERT_TRUE(body.excess(held.machine) <= 0);
  TEST_ASSERT_TRUE(body.excess(body.fitted(std::numeric_limits<double>::infinity()).machine) > 0.1);
}

void a_body_that_cannot_be_is_moved_to_where_it_can() {
  const ImpossibleBody body;
  const Fit outside = body.fitted(1e6);
  TEST_ASSERT_FALSE(bodies_can_be(body.observations, outside));
  const std::vector<Chosen> moved = with_possible_bodies(body.observations, outside);
  TEST_ASSERT_TRUE(body.excess(machine_with(body.observations, moved)) <= 0);
  // Where a fit by simulation stays inside, and leaves no more than one held from the beginning.
  const Fit settled = fit(body.observations, moved, 20);
  TEST_ASSERT_TRUE(body.excess(settled.machine) <= 0);
  TEST_ASSERT_TRUE(settled.train_sum < 1.05 * body.fitted(1e-4).train_sum);
}

/// A plain refit predicts them, so that the updated model is not behind it.
void torques_that_no_body_has_are_predicted_by_a_regression() {
  const ImpossibleBody body;
  const Observations& observations = body.observations;
  const Fit fit = fitted(observations);
  const double noise =
      observations.rms(Eigen::VectorXd::Ones(observations.size()), simulation::joint_torque, true);
  TEST_ASSERT_TRUE(observations.rms(fit.remainder, simulation::joint_torque, true) < 1.2 * noise);
  TEST_ASSERT_TRUE(std::any_of(fit.chosen.begin(), fit.chosen.end(),
                               [](const Chosen& each) { return each.hypothesis.is_regression; }));
}

/// Links that are all heavier by as much give torques that larger gains would give as well. A
/// regression has no need of gains.
void links_that_are_all_heavier_are_not_taken_for_gains() {
  constexpr double kHeavier = 0.3;
  simulation::Machine truth = robot().machine();
  for (int joint = 2; joint <= 6; ++joint) {
    const double mass = robot().robot.elastic.joints[static_cast<std::size_t>(joint - 1)].mass;
    effects::find_law("link_mass", "body")->apply({kHeavier * mass}, joint, &truth);
  }
  const Observations observations = robot().observed(truth);
  const Fit fit = fitted(observations);
  const double noise =
      observations.rms(Eigen::VectorXd::Ones(observations.size()), simulation::joint_torque, true);
  TEST_ASSERT_TRUE(observations.rms(fit.remainder, simulation::joint_torque, true) < 1.1 * noise);
  TEST_ASSERT_TRUE(std::none_of(fit.chosen.begin(), fit.chosen.end(), [](const Chosen& each) {
    return each.hypothesis.traits().is_gain;
  }));
}

/// Gains multiply what a body does that is held at the edge of what can be.
void numbers_settle_where_no_step_lowers_their_cost() {
  ImpossibleBody body;
  simulation::Machine truth = body.truth();
  effects::find_law("torque_gain", "")->apply({0.4}, 2, &truth);
  effects::find_law("torque_gain", "")->apply({-0.3}, 3, &truth);
  body.observations = robot().observed(truth);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(body.observations);
  const Dictionary dictionary(body.observations, hypotheses, [](std::size_t, std::size_t) {});
  std::vector<Chosen> chosen = body.fitted(1e-3).chosen;
  chosen.front().values = {0, 0, 0, 0};
  for (const int joint : {2, 3}) {
    Hypothesis gain(effects::find_law("torque_gain", ""), joint, robot().robot);
    gain.set_bounds({{-0.5, 1, 0.1}});
    chosen.push_back({gain, {0}});
  }
  const Fit settled = settle(body.observations, {chosen, 1}, 0, dictionary);
  TEST_ASSERT_TRUE(bodies_can_be(body.observations, settled));
  const Fit further = fit(body.observations, settled.chosen, 200);
  TEST_ASSERT_TRUE(settled.train_sum < 1.01 * further.train_sum);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_body_with_an_edge_is_held_within_what_can_be);
  RUN_TEST(a_body_that_cannot_be_is_moved_to_where_it_can);
  RUN_TEST(torques_that_no_body_has_are_predicted_by_a_regression);
  RUN_TEST(links_that_are_all_heavier_are_not_taken_for_gains);
  RUN_TEST(numbers_settle_where_no_step_lowers_their_cost);
  RUN_TEST(gains_are_told_beside_what_they_multiply);
  RUN_TEST(what_a_gain_multiplies_has_derivatives_that_it_multiplies);
  RUN_TEST(friction_that_falls_with_speed_joins_the_family_at_its_joint);
  RUN_TEST(friction_that_falls_and_rises_is_proposed_whole);
  RUN_TEST(friction_that_hides_behind_a_latecomer_joins_after_it);
  RUN_TEST(friction_of_all_joints_is_told_and_nothing_else_beside_it);
  return UNITY_END();
}
