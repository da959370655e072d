// Limits of what a recording can tell, and forms for what no known effect explains.
#include <algorithm>
#include <cmath>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/excitation.hpp"
#include "diagnosis/proposal.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Dictionary;
using flexcomp::diagnosis::Excitation;
using flexcomp::diagnosis::Hypothesis;
using flexcomp::diagnosis::Observations;
using flexcomp::diagnosis::Proposal;
using flexcomp::test::kTcpNoise;
using flexcomp::test::SwingingRobot;

namespace {

Proposal proposal_for(const Observations& observations) {
  return propose(observations, fit(observations, {}, 0));
}

std::vector<Excitation> excitation_of(const Observations& observations) {
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  return excitation(observations, hypotheses, dictionary);
}

void nothing_is_proposed_for_noise() {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    TEST_ASSERT_TRUE(proposal_for(SwingingRobot(seed).observed()).terms.empty());
  }
}

void a_joint_that_follows_another_one_is_proposed_with_its_ratio() {
  const SwingingRobot swinging(1);
  const Eigen::VectorXd q = swinging.scene.q.col(2);
  const Proposal proposal =
      proposal_for(swinging.observed(swinging.moved_by(5, 4e-4 * (q.array() - q[0]))));
  TEST_ASSERT_EQUAL_UINT64(1, proposal.terms.size());
  TEST_ASSERT_EQUAL_STRING("angle of joint 5 in error by angle of joint 3",
                           proposal.terms.front().text.c_str());
  TEST_ASSERT_EQUAL_STRING("rad/rad", proposal.terms.front().unit.c_str());
  TEST_ASSERT_DOUBLE_WITHIN(4 * proposal.terms.front().deviation, 4e-4,
                            proposal.terms.front().coefficient);
  TEST_ASSERT_TRUE(proposal.terms.front().deviation < 1e-5);
}

void two_terms_are_proposed_where_there_are_two() {
  const SwingingRobot swinging(2);
  const Eigen::MatrixXd first =
      swinging.moved_by(1, 1e-4 * swinging.scene.velocity.col(3).cwiseAbs());
  const Eigen::MatrixXd second = swinging.moved_by(4, 3e-4 * swinging.scene.q.col(0));
  const Proposal proposal = proposal_for(swinging.observed(first + second));
  TEST_ASSERT_EQUAL_UINT64(2, proposal.terms.size());
  std::vector<std::string> texts = {proposal.terms[0].text, proposal.terms[1].text};
  std::sort(texts.begin(), texts.end());
  TEST_ASSERT_EQUAL_STRING("angle of joint 1 in error by |speed of joint 4|", texts[0].c_str());
  TEST_ASSERT_EQUAL_STRING("angle of joint 4 in error by angle of joint 1", texts[1].c_str());
}

void a_zero_is_known_as_well_as_its_lever_and_the_noise_allow() {
  const SwingingRobot swinging(3);
  const Observations observations = swinging.observed();
  double squares = 0;  // of the TCP's distance from axis 1, over the samples to fit to
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const auto& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.component < 2) {
      const double other = swinging.predicted(at.row, 1 - at.component);
      squares += other * other;
    }
  }
  const double expected = 1.96 * kTcpNoise / std::sqrt(squares);
  const Excitation first = excitation_of(observations).front();
  TEST_ASSERT_DOUBLE_WITHIN(0.1 * expected, expected, first.zero);
  TEST_ASSERT_EQUAL_INT(10, first.reversals);  // 0.131 Hz, twice a period, for 40 s
}

void of_a_joint_that_stands_under_the_tcp_nothing_can_be_told() {
  const std::vector<Excitation> all = excitation_of(SwingingRobot(4).observed());
  TEST_ASSERT_EQUAL_STRING("nothing: none of its errors would show in what was measured",
                           verdict(all[5]).c_str());
  TEST_ASSERT_EQUAL_STRING_LEN("zero to ", verdict(all[1]).c_str(), 8);
}

void of_a_joint_that_bears_nothing_its_friction_can_be_told() {
  flexcomp::test::DrivenRobot driven;
  for (const std::size_t link : {4U, 5U}) {
    driven.robot.elastic.joints[link].mass = 0;
    driven.robot.link_inertia[link].setZero();
  }
  flexcomp::simulation::Machine truth = driven.machine();
  truth.robot.dynamics[4].coulomb = 30;
  const Excitation fifth = excitation_of(driven.observed(truth))[4];
  TEST_ASSERT_TRUE(fifth.largest_load < fifth.friction);
  TEST_ASSERT_EQUAL_STRING_LEN("friction to ", verdict(fifth).c_str(), 12);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(nothing_is_proposed_for_noise);
  RUN_TEST(a_joint_that_follows_another_one_is_proposed_with_its_ratio);
  RUN_TEST(two_terms_are_proposed_where_there_are_two);
  RUN_TEST(a_zero_is_known_as_well_as_its_lever_and_the_noise_allow);
  RUN_TEST(of_a_joint_that_stands_under_the_tcp_nothing_can_be_told);
  RUN_TEST(of_a_joint_that_bears_nothing_its_friction_can_be_told);
  return UNITY_END();
}
