// A learnt model is a machine that can be, whatever was recorded; what cannot be is no finding.
#include <cmath>
#include <random>
#include <set>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/output/json.hpp"
#include "diagnosis/plausible.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "effects/learned.hpp"
#include "host/scratch_folder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::diagnosis;
using flexcomp::test::ScratchFolder;
using flexcomp::test::SwingingRobot;
using recording::Samples;

namespace {

double uniform(std::mt19937* random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(*random);
}

void add_noise(double deviation, std::mt19937* random, Samples* values) {
  std::normal_distribution<double> normal(0, deviation);
  *values = values->unaryExpr([&](double value) { return value + normal(*random); });
}

const std::string kDesktopArm = FLEXCOMP_TEST_DATA "/desktop_arm.yaml";

/// A random recording of a desktop arm: 5 s at 100 Hz, encoders of 0.4 mrad, torques in which noise
/// may be all that is seen; the arm has friction, masses and a load that the model lacks. Some show
/// the TCP or link encoders as well.
recording::Recording random_recording(const model::Robot& robot, unsigned seed) {
  constexpr Eigen::Index kRows = 500;
  constexpr double kCounts = 4e-4;  // rad
  std::mt19937 random(seed);
  recording::Recording recording;
  recording.file = "desktop.csv";
  recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, 0.01 * (kRows - 1));
  Samples q(kRows, 6);
  for (Eigen::Index joint = 0; joint < 6; ++joint) {
    q.col(joint).setConstant(uniform(&random, -0.5, 0.5));
    for (int wave = 0; wave < 3; ++wave) {
      const double omega = 2 * M_PI * uniform(&random, 0.1, 0.8);
      const double phase = uniform(&random, 0, 2 * M_PI);
      q.col(joint).array() +=
          uniform(&random, 0.01, 0.4) * (omega * recording.time.array() + phase).sin();
    }
  }
  recording.q_meas = q;
  recording.tau = Samples::Zero(kRows, 6);
  if (seed % 3 == 1) {
    recording.position = Samples::Zero(kRows, 3);
  } else if (seed % 3 == 2) {
    recording.q_link = q;
  }
  simulation::Preparation preparation;
  const simulation::Scene scene = simulation::prepare(recording, kRows, &preparation);
  simulation::Machine truth = effects::machine_of(robot, {scene});
  const double share =
      uniform(&random, 0.2, 1);  // of the masses: a payload would have to be less than none
  for (std::size_t i = 0; i < 6; ++i) {
    truth.robot.elastic.joints[i].mass *= share * uniform(&random, 0.8, 1.2);
    truth.robot.link_inertia[i] *= share;
    truth.robot.dynamics[i].coulomb = uniform(&random, 0, 0.4);
    truth.robot.dynamics[i].viscous = uniform(&random, 0, 0.3);
    truth.robot.dynamics[i].rotor_inertia = uniform(&random, 0, 0.02);
  }
  if (seed % 2 == 0) {
    truth.robot.elastic.payload_mass = uniform(&random, 0, 0.5);
    truth.robot.elastic.payload_center = {0.03, 0, 0};
  }
  const simulation::Prediction shown = simulate(truth, scene).prediction;
  recording.tau = shown.channel[simulation::joint_torque];
  add_noise(std::pow(10, uniform(&random, -2, 0.5)), &random, &*recording.tau);
  if (recording.position) {
    recording.position = shown.channel[simulation::tcp_position];
    add_noise(1e-4, &random, &*recording.position);
  }
  if (recording.q_link) {
    recording.q_link = q + shown.channel[simulation::joint_deflection];
  }
  const auto count = [&](double value) { return kCounts * std::round(value / kCounts); };
  recording.q_meas = q.unaryExpr(count);
  return recording;
}

/// Sum of the joints' friction is no drive, masses and springs are none below nothing.
void assert_can_be(const model::Robot& robot) {
  TEST_ASSERT_TRUE(validate(robot.elastic) == Result::ok);
  TEST_ASSERT_TRUE(robot.elastic.payload_mass >= 0);
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_TRUE(robot.dynamics[i].viscous >= 0);
    TEST_ASSERT_TRUE(robot.dynamics[i].coulomb >= 0);
    TEST_ASSERT_TRUE(robot.dynamics[i].rotor_inertia >= 0);
    TEST_ASSERT_TRUE(robot.elastic.joints[i].mass > 0);
  }
}

void what_is_learnt_of_random_recordings_is_a_machine_that_can_be() {
  constexpr unsigned kRecordings = 3;  // of desktop arms; half of such made an internal fault
  const model::Robot robot = model::load_robot(kDesktopArm);
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    const recording::Recording recording = random_recording(robot, seed);
    simulation::Preparation preparation;
    const std::vector<simulation::Scene> scenes = {
        simulation::prepare(recording, recording.size(), &preparation)};
    Observations observations(effects::machine_of(robot, scenes), scenes, 0);
    const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
    const Diagnosis found = diagnose(&observations, hypotheses, flexcomp::test::quiet_settings(0));
    TEST_ASSERT_FALSE(to_json(observations, found).dump().empty());
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "updated_model.yaml";
    model::write_robot(file, effects::with_learned(robot, found.updated().placed(observations)));
    const model::Robot learnt = model::load_robot(file);
    assert_can_be(learnt);
    assert_can_be(effects::machine_of(learnt, scenes).robot);
  }
}

/// The whole of what a recording can show, with a tool that is longer by `length` (m) than the
/// model's, and a force on it that changes.
Observations with_longer_tool(const SwingingRobot& swinging, double length) {
  recording::Recording shown = swinging.recording;
  const Eigen::ArrayXd time = shown.time.array();
  shown.wrench = Samples::Zero(shown.size(), 6);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    shown.wrench->col(axis) = 300 * (2 + 0.3 * static_cast<double>(axis) * time).sin();
  }
  simulation::Preparation preparation;
  const simulation::Scene scene = simulation::prepare(shown, shown.size(), &preparation);
  simulation::Machine truth = effects::machine_of(swinging.robot, {scene});
  Pose<double>& tool = truth.robot.elastic.tool;
  tool.position += tool.rotation * Vector3<double>(0, 0, length);
  shown.position = simulate(truth, scene).prediction.channel[simulation::tcp_position];
  std::mt19937 random(3);
  add_noise(2e-5, &random, &*shown.position);
  std::vector<simulation::Scene> scenes = {simulation::prepare(shown, shown.size(), &preparation)};
  simulation::Machine machine = effects::machine_of(swinging.robot, scenes);
  return Observations(std::move(machine), std::move(scenes), 0);
}

void a_tool_that_is_120_mm_longer_is_a_tool_and_no_zero_of_a_sensor() {
  const SwingingRobot swinging(1);
  Observations observations = with_longer_tool(swinging, 0.12);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Diagnosis found = diagnose(&observations, hypotheses, flexcomp::test::quiet_settings(0));
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.fit.chosen.size());
  const Chosen& tool = found.choice.fit.chosen.front();
  TEST_ASSERT_EQUAL_STRING("tcp_offset", tool.hypothesis.effect().c_str());
  TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.12, tool.values[2]);
}

/// No tool of a KR 270 is 2 m long: the recording belongs to something else, and nothing may be
/// made of it.
void an_error_beyond_what_any_tool_can_be_is_no_finding() {
  const SwingingRobot swinging(1);
  Observations observations = with_longer_tool(swinging, 2);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Diagnosis found = diagnose(&observations, hypotheses, flexcomp::test::quiet_settings(0));
  for (std::size_t i = 0; i < found.updated().chosen.size(); ++i) {
    TEST_ASSERT_EQUAL_STRING("", why_impossible(observations, found.updated(), i).c_str());
    TEST_ASSERT_TRUE(found.updated().chosen[i].hypothesis.effect() != "tcp_offset");
  }
}

/// Everything that a recording can have, so that every effect offers itself.
Observations showing_all(const model::Robot& robot, bool is_warmed, bool has_encoders) {
  constexpr Eigen::Index kRows = 60;
  recording::Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, 0.1 * (kRows - 1));
  Samples q(kRows, 6);
  for (Eigen::Index joint = 0; joint < 6; ++joint) {
    q.col(joint) = 0.4 * (recording.time.array() * (1 + 0.1 * static_cast<double>(joint))).sin();
  }
  (has_encoders ? recording.q_meas : recording.q_cmd) = q;
  if (has_encoders) {
    recording.q_link = q;
  }
  recording.position = Samples::Random(kRows, 3);
  recording.tau = 500 * Samples::Random(kRows, 6);
  recording.wrench = Samples::Random(kRows, 6);
  if (is_warmed) {
    recording.temperature = Samples::Random(kRows, 1);
  }
  simulation::Preparation preparation;
  std::vector<simulation::Scene> scenes = {simulation::prepare(recording, kRows, &preparation)};
  simulation::Machine machine = effects::machine_of(robot, scenes);
  return Observations(std::move(machine), std::move(scenes), 0);
}

void every_parameter_of_every_effect_has_a_plausible_range_with_its_source() {
  std::set<std::string> seen;
  for (const char* const name : {"kr100", "kr270", "kr360", "kr500", ""}) {
    model::Robot robot = model::load_robot(
        *name != 0 ? std::string(FLEXCOMP_ROBOTS "/") + name + "/robot.yaml" : kDesktopArm);
    for (model::JointDynamics& motor : robot.dynamics) {
      motor.coulomb = 1;  // N·m, so that a coupled drive could show
    }
    for (const bool is_warmed : {true, false}) {
      const Observations observations = showing_all(robot, is_warmed, is_warmed);
      for (const Hypothesis& hypothesis : all_hypotheses(observations)) {
        seen.insert(hypothesis.effect());
        for (const Parameter& parameter : hypothesis.parameters) {
          const Range range = plausible_range(*hypothesis.law, robot, size_of(observations),
                                              hypothesis.joint, parameter.name);
          const std::string what = hypothesis.effect() + " " + parameter.name;
          TEST_ASSERT_TRUE_MESSAGE(*range.source != 0, what.c_str());
          TEST_ASSERT_TRUE_MESSAGE(range.lower <= range.upper, what.c_str());
          TEST_ASSERT_TRUE_MESSAGE(parameter.lower <= parameter.upper, what.c_str());
        }
      }
    }
  }
  TEST_ASSERT_EQUAL_UINT64(effects::catalogue().size(), seen.size());
}

/// One hypothesis of an effect, the first whose form is `form`.
const Hypothesis& of_effect(const std::vector<Hypothesis>& all, const std::string& effect,
                            int joint, const std::string& form = "") {
  for (const Hypothesis& each : all) {
    if (each.effect() == effect && each.joint == joint && each.law->form == form) {
      return each;
    }
  }
  TEST_FAIL_MESSAGE(effect.c_str());
  return all.front();
}

struct Case {
  const char* effect;
  int joint;
  const char* form;
  Values values;
};

void what_no_machine_can_be_is_said_to_be_so() {
  const model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml");
  const Observations timed = showing_all(robot, false, true);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(timed);
  const auto possible = [&](const Case& of) {
    const Hypothesis& hypothesis = of_effect(hypotheses, of.effect, of.joint, of.form);
    Fit fit;
    fit.chosen = {{hypothesis, of.values}};
    fit.machine = machine_with(timed, fit.chosen);
    return why_impossible(timed, fit, 0).empty();
  };
  const Case kCannot[] = {{"backlash", 2, "motion", {0.03}},
                          {"coulomb_friction", 6, "", {2000}},
                          {"joint_stiffness", 2, "", {-0.29e-6}},
                          {"link_mass", 2, "body", {-0.95 * 220}},
                          {"link_mass", 2, "mounted", {0, 0, 0, 300}},
                          {"payload", 0, "", {-5, 0, 0, 0}},
                          {"payload", 0, "", {20, 0, 0, 60}},
                          {"thermal_drift", 0, "time", {1e-4, 0, 0, 2}},
                          {"thermal_drift", 0, "time", {0.015, 0, 0, 300}},
                          {"tcp_offset", 0, "", {0, 0, 2}},
                          {"tcp_offset", 0, "", {0, 0, std::nan("")}},
                          {"wrench_bias", 0, "", {0, 0, -64e3, 0, 0, 0}},
                          {"wrench_bias", 0, "", {0, 0, 0, 38e3, 0, 0}}};
  for (const Case& each : kCannot) {
    TEST_ASSERT_FALSE_MESSAGE(possible(each), each.effect);
  }
  const Case kCan[] = {{"backlash", 2, "motion", {0.0003}},
                       {"coulomb_friction", 6, "", {300}},
                       {"joint_stiffness", 2, "", {0.3e-6}},
                       {"link_mass", 2, "body", {-0.5 * 220}},
                       {"link_mass", 2, "mounted", {30, 0, 0, 20}},
                       {"payload", 0, "", {150, 10, 0, 60}},
                       {"thermal_drift", 0, "time", {1e-4, 0, 0, 600}},
                       {"tcp_offset", 0, "", {0, 0, 0.12}},
                       {"wrench_bias", 0, "", {0, 0, -640, 38, 0, 0}}};
  for (const Case& each : kCan) {
    TEST_ASSERT_TRUE_MESSAGE(possible(each), each.effect);
  }
}

void a_fit_that_rests_on_a_bound_is_no_finding_unless_the_bound_is_nothing() {
  const model::Robot robot = model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml");
  const Observations observations = showing_all(robot, true, true);
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const auto why = [&](const Hypothesis& hypothesis, const Values& values) {
    Fit fit;
    fit.chosen = {{hypothesis, values}};
    fit.machine = machine_with(observations, fit.chosen);
    return why_impossible(observations, fit, 0);
  };
  const Hypothesis& axis = of_effect(hypotheses, "joint_axis", 3);
  TEST_ASSERT_EQUAL_STRING("", why(axis, {0.01, 0}).c_str());
  TEST_ASSERT_EQUAL_STRING("tilt_x rests on its bound of 0.1 rad", why(axis, {0.1, 0}).c_str());
  const Hypothesis& base = of_effect(hypotheses, "base_compliance", 0);
  TEST_ASSERT_EQUAL_STRING("", why(base, {0, 0, 0, 1e-7, 1e-7, 0}).c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_is_learnt_of_random_recordings_is_a_machine_that_can_be);
  RUN_TEST(a_tool_that_is_120_mm_longer_is_a_tool_and_no_zero_of_a_sensor);
  RUN_TEST(an_error_beyond_what_any_tool_can_be_is_no_finding);
  RUN_TEST(every_parameter_of_every_effect_has_a_plausible_range_with_its_source);
  RUN_TEST(what_no_machine_can_be_is_said_to_be_so);
  RUN_TEST(a_fit_that_rests_on_a_bound_is_no_finding_unless_the_bound_is_nothing);
  return UNITY_END();
}
