// The choice among several attempts, and what stays with it.
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <numeric>
#include <set>

#include "diagnosis/diagnosed.hpp"
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

/// The swinging robot under gravity, seen by an instrument in another frame: the spring of joint 2
/// gives twice as much, and the zero of joint 3 is off by 2 mrad.
Observations sagging_in(const Eigen::Isometry3d& frame) {
  const SwingingRobot swinging(1);
  flexcomp::model::Robot robot = swinging.robot;
  robot.elastic.gravity = {0, 0, -9.81};
  flexcomp::recording::Recording recording = swinging.recording;
  flexcomp::simulation::Preparation preparation;
  const auto prepared = [&] { return prepare(recording, recording.size(), &preparation); };
  const flexcomp::simulation::Machine machine = flexcomp::effects::machine_of(robot, {prepared()});
  flexcomp::simulation::Machine truth = machine;
  truth.robot.elastic.joints[1].compliance *= 2;
  flexcomp::simulation::Scene turned = prepared();
  turned.q.col(2).array() += 2e-3;
  const Eigen::MatrixXd shown =
      simulate(truth, turned).prediction.channel[flexcomp::simulation::tcp_position];
  const Eigen::MatrixXd noise = *swinging.recording.position - swinging.predicted;
  recording.position = (frame * Eigen::Matrix3Xd(shown.transpose())).transpose() + noise;
  return Observations(machine, {prepared()}, 0);
}

/// What a whole diagnosis names, in the order of the alphabet.
std::string named_in(Observations observations) {
  std::set<std::string> names;
  for (const Finding& finding : flexcomp::test::findings_of(std::move(observations))) {
    const Hypothesis& found = finding.chosen.hypothesis;
    names.insert(found.effect() + " " + std::to_string(found.joint) + "; ");
  }
  return std::accumulate(names.begin(), names.end(), std::string());
}

/// Beside the frame each alone is imitated by other effects, and these by more of them.
void two_causes_behind_a_frame_are_found_together() {
  for (const double away : {0.8e-3, 20e-3}) {  // m: an ordinary search finds it, and registration
    Eigen::Isometry3d frame(Eigen::AngleAxisd(2 * away, Eigen::Vector3d(1, 1, 1).normalized()));
    frame.pretranslate(Eigen::Vector3d(-0.6, -0.4, 0.8) * away);
    TEST_ASSERT_EQUAL_STRING("base_frame 0; joint_offset 3; joint_stiffness 2; ",
                             named_in(sagging_in(frame)).c_str());
  }
}

/// What screening says a pair leaves, beside columns that are fitted, is what least squares leave.
void a_pair_is_screened_beside_what_is_fitted() {
  const SwingingRobot swinging(1);
  const Observations observations = swinging.observed(
      swinging.moved_by(2, Eigen::VectorXd::Constant(swinging.rows(), kOffset)) +
      swinging.moved_by(kJoint, Eigen::VectorXd::Constant(swinging.rows(), -kOffset)));
  const Dictionary dictionary(observations, all_hypotheses(observations),
                              [](std::size_t, std::size_t) {});
  const Eigen::Index n = observations.train;
  const Eigen::MatrixXd fitted = dictionary.columns.leftCols(3);
  const BesideFitted beside(observations, dictionary, observations.residual, fitted);
  const std::vector<ScreenedPair> pairs =
      screen_pairs(observations, dictionary.hypotheses, dictionary, beside, 3);
  TEST_ASSERT_FALSE(pairs.empty());
  for (const ScreenedPair& pair : pairs) {
    const Entry& first = dictionary.entries[pair.first.entry];
    const Entry& second = dictionary.entries[pair.second.entry];
    Eigen::MatrixXd columns(n, fitted.cols() + first.count + second.count);
    columns << fitted.topRows(n),
        dictionary.columns.middleCols(first.first, first.count).topRows(n),
        dictionary.columns.middleCols(second.first, second.count).topRows(n);
    const Eigen::VectorXd target = observations.residual.head(n);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(columns);
    const double left = (target - columns * factors.solve(target)).squaredNorm();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * target.squaredNorm(), left, pair.sum);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_attempt_that_loses_leaves_nothing_behind);
  RUN_TEST(a_number_is_told_from_nothing_where_its_95_percent_interval_leaves_nothing_out);
  RUN_TEST(two_causes_behind_a_frame_are_found_together);
  RUN_TEST(a_pair_is_screened_beside_what_is_fitted);
  return UNITY_END();
}
