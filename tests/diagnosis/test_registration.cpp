// Where an instrument stands, that measured positions in a frame of its own.
#include <Eigen/Geometry>

#include "diagnosis/registration.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::kTcpNoise;
using test::SwingingRobot;

namespace {

const SwingingRobot& swinging() {
  static const SwingingRobot robot(1);
  return robot;
}

/// 100° about a slanting axis, and 2 m away.
Eigen::Isometry3d far_away() {
  const double angle = 100 * M_PI / 180;
  Eigen::Isometry3d frame(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 2).normalized()));
  frame.pretranslate(Eigen::Vector3d(1.2, -1.6, 0));
  return frame;
}

/// Positions (n × 3) in another frame.
Eigen::MatrixXd seen_in(const Eigen::Isometry3d& frame, const Eigen::MatrixXd& positions) {
  return (frame * Eigen::Matrix3Xd(positions.transpose())).transpose();
}

/// The swinging robot by an instrument in a frame.
Observations observed_in(const Eigen::Isometry3d& frame, Eigen::MatrixXd error) {
  return swinging().observed(seen_in(frame, swinging().predicted) - swinging().predicted + error);
}

Eigen::MatrixXd none() { return Eigen::MatrixXd::Zero(swinging().rows(), 3); }

Fit registered(const Observations& observations) {
  return register_frame(observations, all_hypotheses(observations));
}

/// Largest distance of the positions in a frame as fitted from those in the true one.
double largest_miss(const Fit& fit, const Eigen::Isometry3d& frame) {
  const diagnosis::Values& found = fit.chosen.front().values;
  const Eigen::Vector3d turn(found[3], found[4], found[5]);
  Eigen::Isometry3d as_found(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  as_found.pretranslate(Eigen::Vector3d(found[0], found[1], found[2]));
  return (seen_in(as_found, swinging().predicted) - seen_in(frame, swinging().predicted))
      .rowwise()
      .norm()
      .maxCoeff();
}

void assert_frame_alone(const Fit& fit) {
  TEST_ASSERT_EQUAL_UINT64(1, fit.chosen.size());
  TEST_ASSERT_EQUAL_STRING("base_frame", fit.chosen.front().hypothesis.effect().c_str());
  TEST_ASSERT_TRUE(largest_miss(fit, far_away()) < kTcpNoise);
}

void an_instrument_turned_by_100_degrees_and_2_m_away_is_registered_to_within_noise() {
  assert_frame_alone(registered(observed_in(far_away(), none())));
}

/// One sample in fifty is of a reflection: half of them far off in all coordinates, half in one.
void single_reflections_do_not_move_the_frame() {
  Eigen::MatrixXd error = none();
  for (Eigen::Index row = 20; row < error.rows(); row += 100) {
    error.row(row) << 0.3, 0.2, -0.4;
    error(row + 50, 2) = 0.5;
  }
  assert_frame_alone(registered(observed_in(far_away(), error)));
}

void nothing_is_registered_where_the_frame_is_right() {
  const Observations observations = observed_in(Eigen::Isometry3d::Identity(), none());
  TEST_ASSERT_TRUE(registered(observations).chosen.empty());
  Eigen::Isometry3d near = Eigen::Isometry3d::Identity();
  near.translation().x() = 2e-3;  // m: an ordinary search finds it
  TEST_ASSERT_TRUE(registered(observed_in(near, none())).chosen.empty());
}

/// The swinging robot with swings that are smaller by a factor and a tool that is longer (m), by an
/// instrument far away.
Observations varied(double factor, double longer) {
  recording::Recording recording = swinging().recording;
  recording::Samples& q = *recording.q_meas;
  const Eigen::RowVectorXd middle = q.colwise().mean();
  q = (factor * (q.rowwise() - middle)).rowwise() + middle;
  simulation::Preparation preparation;
  const simulation::Scene scene = prepare(recording, recording.size(), &preparation);
  const simulation::Machine machine = effects::machine_of(swinging().robot, {scene});
  simulation::Machine truth = machine;
  Pose<double>& tool = truth.robot.elastic.tool;
  tool.position += tool.rotation * Eigen::Vector3d(0, 0, longer);
  const Eigen::MatrixXd shown = simulate(truth, scene).prediction.channel[simulation::tcp_position];
  const Eigen::MatrixXd noise = *swinging().recording.position - swinging().predicted;
  recording.position = seen_in(far_away(), shown) + noise;
  return Observations(machine, {prepare(recording, recording.size(), &preparation)}, 0);
}

void nothing_is_registered_by_a_small_path() {
  TEST_ASSERT_EQUAL_UINT64(1, registered(varied(1, 0)).chosen.size());
  TEST_ASSERT_TRUE(registered(varied(0.05, 0)).chosen.empty());
}

void a_tool_that_is_80_mm_longer_is_found_beside_the_frame() {
  constexpr double kLonger = 0.08;
  const Fit fit = registered(varied(1, kLonger));
  TEST_ASSERT_EQUAL_UINT64(2, fit.chosen.size());
  TEST_ASSERT_TRUE(largest_miss(fit, far_away()) < 3 * kTcpNoise);
  TEST_ASSERT_EQUAL_STRING("tcp_offset", fit.chosen.back().hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(kTcpNoise, 0, fit.chosen.back().values[0]);
  TEST_ASSERT_DOUBLE_WITHIN(kTcpNoise, 0, fit.chosen.back().values[1]);
  TEST_ASSERT_DOUBLE_WITHIN(kTcpNoise, kLonger, fit.chosen.back().values[2]);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_instrument_turned_by_100_degrees_and_2_m_away_is_registered_to_within_noise);
  RUN_TEST(single_reflections_do_not_move_the_frame);
  RUN_TEST(nothing_is_registered_where_the_frame_is_right);
  RUN_TEST(nothing_is_registered_by_a_small_path);
  RUN_TEST(a_tool_that_is_80_mm_longer_is_found_beside_the_frame);
  return UNITY_END();
}
