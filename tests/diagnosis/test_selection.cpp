// The choice among several attempts, and what stays with it.
#include "diagnosis/select/judge.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp::diagnosis;
using flexcomp::test::SwingingRobot;

namespace {

constexpr int kJoint = 3;
constexpr double kOffset = 4e-4;  // rad

/// An attempt, with a dictionary of its own that was sought in what it leaves.
Attempt attempt_of(const Observations& observations, const Dictionary& dictionary,
                   std::vector<Chosen> chosen) {
  return {fit(observations, std::move(chosen), 12), std::make_shared<const Dictionary>(dictionary)};
}

void an_attempt_that_loses_leaves_nothing_behind() {
  const SwingingRobot swinging(1);
  const Eigen::MatrixXd error =
      swinging.moved_by(kJoint, Eigen::VectorXd::Constant(swinging.rows(), kOffset));
  const Observations observations = swinging.observed(error);
  const Dictionary dictionary(observations, all_hypotheses(observations),
                              [](std::size_t, std::size_t) {});
  const Fit given = fit(observations, {}, 0);
  const Inquiry inquiry{observations, dictionary, 0.01, given};
  const Attempt nothing = attempt_of(observations, dictionary, {});
  const Attempt right = [&] {
    for (const Hypothesis& each : dictionary.hypotheses) {
      if (each.effect() == "joint_offset" && each.joint == kJoint) {
        return attempt_of(observations, dictionary, {{each, {kOffset}}});
      }
    }
    TEST_FAIL_MESSAGE("no such hypothesis");
    return nothing;
  }();
  for (const auto& [best, rival] : {std::pair(right, nothing), std::pair(nothing, right)}) {
    const Attempt better = better_of(inquiry, best, rival);
    TEST_ASSERT_EQUAL_UINT64(1, better.fit.chosen.size());
    TEST_ASSERT_TRUE(better.sought == right.sought);
  }
}

/// A zero of a joint with a value and a standard deviation, both in rad.
bool is_told_from_nothing(double value, double deviation) {
  const SwingingRobot swinging(1);
  const Hypothesis hypothesis(flexcomp::effects::find_law("joint_offset", ""), 3, swinging.robot);
  return are_told_from_nothing({hypothesis, {value}},
                               Eigen::MatrixXd::Constant(1, 1, deviation * deviation));
}

void a_number_is_told_from_nothing_where_its_95_percent_interval_leaves_nothing_out() {
  TEST_ASSERT_TRUE(is_told_from_nothing(2.0e-4, 1e-4));
  TEST_ASSERT_TRUE(is_told_from_nothing(-2.0e-4, 1e-4));
  TEST_ASSERT_FALSE(is_told_from_nothing(1.9e-4, 1e-4));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_attempt_that_loses_leaves_nothing_behind);
  RUN_TEST(a_number_is_told_from_nothing_where_its_95_percent_interval_leaves_nothing_out);
  return UNITY_END();
}
