// The noise of samples: what counts for it, and what does not.
#include <cmath>
#include <random>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/observations.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::test;

namespace {

constexpr double kRest = 0.6;   // s, between moves
constexpr double kMove = 0.4;   // s
constexpr double kAway = 0.25;  // rad
constexpr double kStep = 4e-5;  // rad, of the encoders

/// How far of the way a joint is that goes there and back, with a rest before each move: a cycloid.
double way_at(double time) {
  const double period = kRest + kMove;
  const double count = std::floor(time / period);
  const double share = std::max(0.0, (time - count * period - kRest) / kMove);
  const double turn = 2 * std::acos(-1.0);
  const double going = share - std::sin(turn * share) / turn;
  return std::fmod(count, 2.0) == 0 ? going : 1 - going;
}

/// The driven robot from place to place, all joints at once, 250 rows a second.
DrivenRobot picking_and_placing() {
  DrivenRobot driven;
  recording::Recording& recording = driven.recording;
  const Eigen::Index rows = recording.size();
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, 0.004 * static_cast<double>(rows - 1));
  const Eigen::RowVectorXd middle = recording.q_meas->row(0);
  for (Eigen::Index row = 0; row < rows; ++row) {
    recording.q_meas->row(row) =
        ((middle.array() + kAway * way_at(recording.time[row])) / kStep).round() * kStep;
  }
  simulation::Preparation preparation;
  driven.scene = simulation::prepare(recording, rows, &preparation);
  const simulation::Machine machine = driven.machine();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, DrivenRobot::kNoise);
  recording.tau =
      simulation::predict(machine, {driven.scene}).front().channel[simulation::joint_torque];
  *recording.tau = recording.tau->unaryExpr([&](double value) { return value + noise(random); });
  return driven;
}

/// Adds what friction holds where the joints rest, another torque in each rest.
void hold_at_rest(double largest, recording::Recording* recording) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> held(-largest, largest);
  double torque = 0;
  for (Eigen::Index row = 1; row < recording->size(); ++row) {
    const bool rests = std::fmod(recording->time[row], kRest + kMove) < kRest;
    const bool rested = std::fmod(recording->time[row - 1], kRest + kMove) < kRest;
    torque = rests && !rested ? held(random) : torque;
    recording->tau->row(row).array() += rests ? torque : 0;
  }
}

double largest_noise(const DrivenRobot& driven) {
  simulation::Preparation preparation;
  const diagnosis::Observations observations(
      driven.machine(),
      {simulation::prepare(driven.recording, driven.recording.size(), &preparation)}, 0);
  TEST_ASSERT_GREATER_THAN(1000, observations.size());
  return observations.noise.maxCoeff();
}

void what_friction_holds_at_rest_is_no_noise_of_the_motion() {
  DrivenRobot driven = picking_and_placing();
  const double without = largest_noise(driven);
  hold_at_rest(50 * DrivenRobot::kNoise, &driven.recording);
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * without, without, largest_noise(driven));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_friction_holds_at_rest_is_no_noise_of_the_motion);
  return UNITY_END();
}
