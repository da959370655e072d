// A vibration that no formula of the diagnosis made: the recording is of an arm with flexible
// joints as differential equations, on rigid-body dynamics of another library.
#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/output/json.hpp"
#include "effects/learned.hpp"
#include "model/robot.hpp"
#include "simulation/flexible_joint_plant.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "simulation/scene.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using Angles = JointVector<double, 6>;

namespace {

constexpr double kTurn = 2 * M_PI;
constexpr double kStep = 0.001;  // s, of the servo
constexpr int kStepsARow = 10;
constexpr Eigen::Index kRows = 2000;     // 20 s
constexpr double kEncoderNoise = 2e-6;   // rad
constexpr double kSpringDamping = 0.02;  // of critical

/// A KR 360, weightless, whose first joint is ten times softer than the others, which hold.
struct SoftFirstJoint {
  model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr360/robot.yaml");
  simulation::FlexibleArm<6> arm;
  Angles middle;

  SoftFirstJoint() {
    middle << 0, -1.2, 1.4, 0.3, 0.6, 0.1;
    robot.elastic.gravity.setZero();
    for (std::size_t i = 0; i < 6; ++i) {
      robot.elastic.joints[i].compliance = i == 0 ? 5e-7 : 5e-8;
    }
    arm.model = six_axis_model(robot);
    std::copy(robot.link_inertia.begin(), robot.link_inertia.end(), arm.inertia.begin());
    arm.rotor_inertia << 400, 450, 300, 60, 50, 25;
    arm.torque_limit.setConstant(1e9);
  }

  /// Frequency of the first joint's vibration, Hz, while its motor holds still.
  double frequency() const {
    const Angles none = Angles::Zero();
    const Angles unit = Angles::Unit(0);
    const double inertia = simulation::inverse_dynamics(robot, middle, none, unit)[0];
    return std::sqrt(1 / (robot.elastic.joints[0].compliance * inertia)) / kTurn;
  }

  /// Moves of half a second there and back, of twentieths of a radian, with a rest after each.
  static double wanted(double time) {
    constexpr double kPeriod = 1.6;
    const auto move = static_cast<int>(time / kPeriod);
    const double phase = std::min((time - move * kPeriod) / 0.5, 1.0);
    const double way = phase - std::sin(kTurn * phase) / kTurn;
    return 0.05 * (move % 2 == 0 ? way : 1 - way);
  }

  recording::Recording record() const {
    simulation::FlexibleJointPlant<6> plant(arm);
    plant.rest(middle);
    recording::Recording recording;
    recording.file = "flexible.csv";
    recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, kStep * kStepsARow * (kRows - 1));
    recording.q_meas = recording::Samples::Zero(kRows, 6);
    recording.q_link = recording::Samples::Zero(kRows, 6);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, kEncoderNoise);
    for (Eigen::Index row = 0; row < kRows; ++row) {
      for (Eigen::Index joint = 0; joint < 6; ++joint) {
        (*recording.q_meas)(row, joint) = plant.state().motor[joint] + noise(random);
        (*recording.q_link)(row, joint) = plant.state().link[joint] + noise(random);
      }
      for (int i = 0; i < kStepsARow; ++i) {
        servo(&plant, recording.time[row] + i * kStep);
      }
    }
    return recording;
  }

  /// A stiff motor servo, and a little damping in the first spring, which every gear has.
  void servo(simulation::FlexibleJointPlant<6>* plant, double time) const {
    constexpr double kBandwidth = kTurn * 30;  // rad/s
    const auto& state = plant->state();
    Angles error = middle - state.motor;
    error[0] += wanted(time);
    const Angles torque = arm.rotor_inertia.cwiseProduct(kBandwidth * kBandwidth * error -
                                                         2 * kBandwidth * state.motor_velocity);
    Angles damping = Angles::Zero();
    damping[0] = -2 * kSpringDamping / (kTurn * frequency()) * arm.stiffness()[0] *
                 (state.link_velocity[0] - state.motor_velocity[0]);
    plant->advance(torque, damping, kStep, 10);
  }
};

void the_vibration_of_a_flexible_joint_is_found_at_its_joint_with_its_frequency() {
  const SoftFirstJoint soft;
  simulation::Preparation preparation;
  std::vector<simulation::Scene> scenes = {simulation::prepare(soft.record(), kRows, &preparation)};
  simulation::Machine machine = effects::machine_of(soft.robot, scenes);
  diagnosis::Observations observations(std::move(machine), std::move(scenes), 0);
  const auto hypotheses = diagnosis::all_hypotheses(observations);
  const diagnosis::Diagnosis result =
      diagnosis::diagnose(&observations, hypotheses, test::quiet_settings());
  const nlohmann::ordered_json json = diagnosis::to_json(observations, result);
  TEST_ASSERT_FALSE(json.at("findings").empty());
  const auto& first = json.at("findings").at(0);
  TEST_ASSERT_EQUAL_STRING("resonance", first.at("effect").get<std::string>().c_str());
  TEST_ASSERT_EQUAL(1, first.at("joint").get<int>());
  const auto parameter = [&](const char* name) {
    return first.at("parameters").at(name).at("value").get<double>();
  };
  TEST_ASSERT_DOUBLE_WITHIN(0.005 * soft.frequency(), soft.frequency(), parameter("frequency"));
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kSpringDamping, kSpringDamping, parameter("damping"));
  const auto rms = [&](const char* when) {
    return json.at(when).at("joint_deflection").at("holdout_rms").get<double>();
  };
  TEST_ASSERT_TRUE(rms("final") < 0.1 * rms("baseline"));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_vibration_of_a_flexible_joint_is_found_at_its_joint_with_its_frequency);
  return UNITY_END();
}
