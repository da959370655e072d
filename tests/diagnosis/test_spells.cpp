// Effects that come and go while a machine is recorded: found with their moments, beside what
// always acts, and not where nothing comes and goes.
#include <algorithm>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "diagnosis/find_spells.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp::diagnosis;
using flexcomp::test::diagnosed;
using flexcomp::test::DrivenRobot;
namespace effects = flexcomp::effects;

namespace {

constexpr double kOffset = 12;    // N·m, at joint 3
constexpr double kFriction = 40;  // N·m, at joint 2
constexpr double kRow = 0.04;     // s, from row to row

/// The motion with a torque of `course` (N·m over s) at joint 3, and dry friction at joint 2 or
/// none.
flexcomp::simulation::Machine with_torque(const DrivenRobot& robot,
                                          const flexcomp::test::Course& course, bool rubs = false) {
  flexcomp::simulation::Machine truth = robot.machine();
  if (rubs) {
    effects::find_law("coulomb_friction", "")->apply({kFriction}, 2, &truth);
  }
  flexcomp::test::add_torque(3, course, &truth);
  return truth;
}

/// The finding of an effect at a joint; none is a failure of the test.
const Finding& finding_of(const Diagnosis& diagnosis, const std::string& effect, int joint) {
  for (const Finding& each : diagnosis.choice.findings) {
    if (each.chosen.hypothesis.effect() == effect && each.chosen.hypothesis.joint == joint) {
      return each;
    }
  }
  TEST_FAIL_MESSAGE("not found");
  return diagnosis.choice.findings.front();
}

void what_begins_and_stays_is_told_with_its_moment() {
  constexpr double kBegin = 17.3;
  const DrivenRobot robot;
  Observations observations =
      robot.observed(with_torque(robot, [](double time) { return time > kBegin ? kOffset : 0; }));
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  const Finding& finding = finding_of(found, "torque_offset", 3);
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kOffset, kOffset, finding.chosen.values.front());
  const std::vector<Spell> spells = finding.chosen.hypothesis.when->all();
  TEST_ASSERT_EQUAL_UINT64(1, spells.size());
  const Eigen::VectorXd& time = observations.scenes.front().time;
  TEST_ASSERT_DOUBLE_WITHIN(3 * kRow, kBegin, time[spells.front().rows.first]);
  TEST_ASSERT_EQUAL_INT64(time.size(), spells.front().rows.end);
  TEST_ASSERT_TRUE(
      statement(observations, found, 0).find("It does not always act: in swinging.csv from 17.") !=
      std::string::npos);
}

void what_comes_and_goes_is_told_beside_what_always_acts() {
  const DrivenRobot robot;
  const auto acts = [](double time) { return (time > 9 && time < 14) || (time > 22 && time < 30); };
  Observations observations = robot.observed(with_torque(
      robot, [&](double time) { return acts(time) ? kOffset : 0; }, true));
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_UINT64(2, found.choice.findings.size());
  const Finding& steady = finding_of(found, "coulomb_friction", 2);
  TEST_ASSERT_NULL(steady.chosen.hypothesis.when.get());
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kFriction, kFriction, steady.chosen.values.front());
  const Spells& when = *finding_of(found, "torque_offset", 3).chosen.hypothesis.when;
  const Eigen::VectorXd& time = observations.scenes.front().time;
  Eigen::Index wrong = 0;
  for (Eigen::Index row = 0; row < time.size(); ++row) {
    wrong += (when.acts.front()[row] != 0) != acts(time[row]) ? 1 : 0;
  }
  TEST_ASSERT_LESS_OR_EQUAL_INT64(12, wrong);  // three rows at each moment
}

void the_updated_model_is_the_machine_as_it_was_left() {
  const DrivenRobot robot;
  const auto placed = [&](double begin, double end) {
    Observations observations = robot.observed(
        with_torque(robot, [=](double time) { return time > begin && time < end ? kOffset : 0; }));
    return diagnosed(&observations, 0).updated().placed(observations).size();
  };
  TEST_ASSERT_EQUAL_UINT64(1, placed(20, 100));
  TEST_ASSERT_EQUAL_UINT64(0, placed(10, 20));
}

void what_was_held_out_has_moments_of_its_own() {
  const DrivenRobot robot;  // cut at 8, 20 and 40 s; the first part lasts 12 s, the second 20
  Observations observations = robot.observed_in_parts(with_torque(
      robot, [](double time) { return (time > 15 && time < 20) || time > 33 ? kOffset : 0; }));
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  const std::vector<Spell> spells =
      finding_of(found, "torque_offset", 3).chosen.hypothesis.when->all();
  TEST_ASSERT_EQUAL_UINT64(2, spells.size());
  for (const Spell& spell : spells) {
    const double begin = observations.scenes[spell.scene].time[spell.rows.first];
    TEST_ASSERT_DOUBLE_WITHIN(3 * kRow, spell.scene == 0 ? 15 : 33, begin);
  }
}

/// A robot that swings a little, so that its TCP stays within some centimetres, and whose tracker
/// is bumped in the midst.
Observations bumped(double begin) {
  const flexcomp::test::SwingingRobot swinging(1);
  flexcomp::recording::Recording recording = swinging.recording;
  const Eigen::RowVectorXd middle = recording.q_meas->colwise().mean();
  *recording.q_meas = (0.05 * (recording.q_meas->rowwise() - middle)).rowwise() + middle;
  flexcomp::simulation::Preparation preparation;
  const auto scenes = [&] {
    return std::vector<flexcomp::simulation::Scene>{
        flexcomp::simulation::prepare(recording, recording.size(), &preparation)};
  };
  const flexcomp::simulation::Machine machine = effects::machine_of(swinging.robot, scenes());
  const Eigen::MatrixXd noise = *recording.position - swinging.predicted;
  *recording.position = noise + flexcomp::simulation::simulate(machine, scenes().front())
                                    .prediction.channel[flexcomp::simulation::tcp_position];
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    if (recording.time[row] > begin) {
      recording.position->row(row) += Eigen::RowVector3d(2e-4, -1e-4, 3e-4);
    }
  }
  return Observations(machine, scenes(), 0);
}

/// Frames are not sought on a small path. That one jumps shows all the same, as does another tool.
void a_tracker_that_was_bumped_may_be_meant_on_a_small_path() {
  Observations observations = bumped(17.3);
  TEST_ASSERT_FALSE(observations.spans_workspace());
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_EQUAL_STRING("explained", name_of(found.verdict));
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  const Finding& finding = found.choice.findings.front();
  TEST_ASSERT_NOT_NULL(finding.chosen.hypothesis.when.get());
  bool is_meant = finding.chosen.hypothesis.effect() == "base_frame";
  for (const std::vector<Place>& group : found.indistinguishable) {
    is_meant =
        is_meant || std::find(group.begin(), group.end(), Place{"base_frame", 0}) != group.end();
  }
  TEST_ASSERT_TRUE(is_meant);
}

void what_grows_gradually_does_not_come_and_go() {
  const DrivenRobot robot;
  Observations observations =
      robot.observed(with_torque(robot, [](double time) { return 0.6 * time; }));
  for (const Finding& each : diagnosed(&observations, 0).choice.findings) {
    TEST_ASSERT_NULL(each.chosen.hypothesis.when.get());
  }
}

void what_always_acts_has_no_spells() {
  const DrivenRobot robot;
  Observations observations = robot.observed(with_torque(robot, [](double) { return kOffset; }));
  const Diagnosis found = diagnosed(&observations, 0);
  TEST_ASSERT_NULL(finding_of(found, "torque_offset", 3).chosen.hypothesis.when.get());
}

/// What is left less what would be with an effect in some rows, counted as `spells_of` does: each
/// moment costs 50.
double cost(const Observations& observations, const Eigen::VectorXd& left,
            const Eigen::VectorXd& change, const Spells& spells) {
  const Eigen::VectorXd acts = spells.by_sample(observations, observations.size());
  return (left - acts.cwiseProduct(change)).squaredNorm() +
         50 * static_cast<double>(spells.changes());
}

void no_single_spell_costs_less_than_those_chosen() {
  constexpr Eigen::Index kEvery = 7;  // rows: moments that are tried
  const DrivenRobot robot;
  const Observations observations = robot.observed(robot.machine());
  const Eigen::Index rows = observations.scenes.front().rows();
  Eigen::VectorXd change = Eigen::VectorXd::Zero(observations.size());
  Eigen::VectorXd left = observations.residual;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    change[i] = at.component == 4 ? 1 : 0;
    left[i] += at.component == 4 && at.row > 301 && at.row < 555 ? 1 : 0;
  }
  const double chosen = cost(observations, left, change, spells_of(observations, left, change));
  Spells tried{{Eigen::VectorXd::Zero(rows)}};
  TEST_ASSERT_TRUE(chosen <= cost(observations, left, change, tried));
  for (Eigen::Index begin = 0; begin < rows; begin += kEvery) {
    for (Eigen::Index end = begin + kEvery; end <= rows; end += kEvery) {
      tried.acts.front().setZero();
      tried.acts.front().segment(begin, end - begin).setOnes();
      TEST_ASSERT_TRUE(chosen <= cost(observations, left, change, tried) + 1e-9);
    }
  }
}

void spells_are_told_by_their_rows() {
  Spells spells{{Eigen::VectorXd::Zero(6), Eigen::VectorXd::Ones(3)}};
  spells.acts[0] << 1, 0, 0, 1, 1, 0;
  const std::vector<Spell> all = spells.all();
  TEST_ASSERT_EQUAL_UINT64(3, all.size());
  TEST_ASSERT_EQUAL_INT64(0, all[0].rows.first);
  TEST_ASSERT_EQUAL_INT64(1, all[0].rows.end);
  TEST_ASSERT_EQUAL_INT64(3, all[1].rows.first);
  TEST_ASSERT_EQUAL_INT64(5, all[1].rows.end);
  TEST_ASSERT_EQUAL_UINT64(1, all[2].scene);
  TEST_ASSERT_EQUAL_INT64(3, all[2].rows.end);
  TEST_ASSERT_EQUAL_UINT64(3, spells.changes());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_begins_and_stays_is_told_with_its_moment);
  RUN_TEST(what_comes_and_goes_is_told_beside_what_always_acts);
  RUN_TEST(the_updated_model_is_the_machine_as_it_was_left);
  RUN_TEST(what_was_held_out_has_moments_of_its_own);
  RUN_TEST(a_tracker_that_was_bumped_may_be_meant_on_a_small_path);
  RUN_TEST(what_grows_gradually_does_not_come_and_go);
  RUN_TEST(what_always_acts_has_no_spells);
  RUN_TEST(no_single_spell_costs_less_than_those_chosen);
  RUN_TEST(spells_are_told_by_their_rows);
  return UNITY_END();
}
