// Effects that a robot's file lists: checked and simulated without any recording to search in.
#include <algorithm>

#include "effects/learned.hpp"
#include "effects/moving_robot.hpp"
#include "error.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using effects::Law;
using effects::LawPointer;
using effects::Placed;
using effects::Values;
using test::difference;
using test::MovingRobot;

namespace {

/// Rows of a motion that every law is simulated over: half a second at least.
constexpr Eigen::Index kRows = FLEXCOMP_FEW_CASES ? 50 : 200;

/// Sizes that any machine could have, by unit.
double size_of(const std::string& unit) {
  const std::map<std::string, double> sizes = {
      {"rad", 1e-3},      {"rad/K", 1e-5},  {"m", 1e-3},         {"s", 0.02},
      {"N", 20},          {"N·m", 30},      {"kg", 5},           {"kg·m", 1},
      {"1", 0.05},        {"m/N", 1e-8},    {"rad/(N·m)", 1e-7}, {"rad/(N·m)^3", 1e-15},
      {"Hz", 8},          {"N·m/rad", 1e6}, {"kg·m^2", 10},      {"N·m·s/rad", 20},
      {"rad/s", 0.3},     {"m/K", 1e-5},    {"N/m", 30},         {"1/K", 1e-3},
      {"1/(N·m)^2", 1e-8}};
  return sizes.at(unit);
}

/// Parameters that act in proportion are `share` of a size, the others the whole of it.
Values values_of(const Law& law, const model::Robot& robot, int joint, double share) {
  Values values;
  for (const effects::Parameter& each : law.parameters(robot, joint)) {
    const bool is_linear = values.size() < law.traits.linear_in;
    values.push_back((is_linear ? share : 1) * size_of(each.unit));
  }
  return values;
}

/// Calls `check(law, joint)` for every law at every place where this robot can have it.
template <typename Check>
void at_every_place(const model::Robot& robot, const Check& check) {
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const LawPointer& law : effect.forms) {
      for (const int joint : law->joints(robot.joints())) {
        if (!law->impossible || law->impossible(robot, joint).empty()) {
          check(law, joint);
        }
      }
    }
  }
}

std::string place_of(const LawPointer& law, int joint) {
  return law->effect + " " + law->form + " at " + std::to_string(joint);
}

void an_effect_of_no_size_changes_nothing() {
  const MovingRobot moving(kRows);
  const simulation::Scene scene = moving.scene();
  const simulation::Machine plain = effects::machine_of(moving.robot);
  const simulation::Prediction as_it_is = simulation::predict(plain, {scene}).front();
  at_every_place(moving.robot, [&](const LawPointer& law, int joint) {
    if (law->traits.linear_in > 0) {
      simulation::Machine machine = plain;
      law->apply(values_of(*law, moving.robot, joint, 0), joint, &machine);
      TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
          1e-9, 0, difference(simulation::predict(machine, {scene}).front(), as_it_is),
          place_of(law, joint).c_str());
    }
  });
}

void an_effect_that_was_learnt_is_simulated_from_the_file_it_is_written_to() {
  const MovingRobot moving(kRows);
  const simulation::Machine plain = effects::machine_of(moving.robot);
  const simulation::Scene measured = moving.scene();
  const simulation::Scene commanded = moving.commanded();
  at_every_place(moving.robot, [&](const LawPointer& law, int joint) {
    const simulation::Scene& scene = law->effect == "servo_lag" ? commanded : measured;
    const Placed found{law, joint, values_of(*law, moving.robot, joint, 1)};
    simulation::Machine machine = plain;
    effects::add_effects({found}, &machine);
    const model::Robot updated = effects::with_learned(moving.robot, {found});
    const std::string place = place_of(law, joint);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
        1e-12, 0, difference(machine, effects::machine_of(updated, {scene}), scene), place.c_str());
    TEST_ASSERT_EQUAL_MESSAGE(law->keys_say_all ? 0 : 1, updated.effects.size(), place.c_str());
  });
}

void a_machine_does_not_depend_on_the_order_in_which_its_effects_are_listed() {
  const MovingRobot moving(kRows);
  const simulation::Scene scene = moving.scene();
  std::vector<Placed> listed = {{effects::find_law("base_frame", ""), 0, {0, 0.01, 0, 0.01, 0, 0}},
                                {effects::find_law("tcp_offset", ""), 0, {0.01, 0.02, 0.03}},
                                {effects::find_law("joint_axis", ""), 3, {0.01, -0.02}},
                                {effects::find_law("joint_axis", ""), 5, {0.02, 0.01}},
                                {effects::find_law("joint_offset", ""), 5, {0.02}},
                                {effects::find_law("torque_offset", ""), 2, {50}},
                                {effects::find_law("torque_gain", ""), 2, {0.1}}};
  simulation::Machine forwards = effects::machine_of(moving.robot);
  effects::add_effects(listed, &forwards);
  std::reverse(listed.begin(), listed.end());
  simulation::Machine backwards = effects::machine_of(moving.robot);
  effects::add_effects(listed, &backwards);
  TEST_ASSERT_EQUAL_DOUBLE(0, difference(forwards, backwards, scene));
}

/// Complaint about a robot that lists an effect; empty where nothing is wrong. There is no
/// length between its last two axes.
std::string said_of(const model::LearnedEffect& listed) {
  MovingRobot moving;
  moving.robot.effects = {listed};
  moving.robot.elastic.joints[5].origin.position.setZero();
  try {
    effects::machine_of(moving.robot);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void assert_said(const char* what, const model::LearnedEffect& listed) {
  const std::string said = said_of(listed);
  TEST_ASSERT_TRUE_MESSAGE(said.find(what) != std::string::npos, said.c_str());
}

void every_mistake_in_the_list_is_refused_without_a_recording() {
  TEST_ASSERT_EQUAL_STRING("", said_of({"backlash", 2, "motion", {{"gap", 1e-4}}, {}}).c_str());
  assert_said("'backslash' is unknown", {"backslash", 2, "motion", {{"gap", 1e-4}}, {}});
  assert_said("backlash needs a form; expected one of: ", {"backlash", 2, "", {{"gap", 1e-4}}, {}});
  assert_said("has no form 'slack'", {"backlash", 2, "slack", {{"gap", 1e-4}}, {}});
  assert_said("needs the parameter 'gap' (rad)", {"backlash", 2, "motion", {}, {}});
  assert_said("has no parameter 'hold'; expected gap",
              {"backlash", 2, "motion", {{"gap", 1e-4}, {"hold", 3}}, {}});
  assert_said("backlash has no joint; expected one of: 1, 2",
              {"backlash", 0, "motion", {{"gap", 1e-4}}, {}});
  assert_said("payload has joint 6; expected none",
              {"payload", 6, "", {{"mass", 1}, {"mx", 0}, {"my", 0}, {"mz", 0}}, {}});
  assert_said("link_length cannot be at joint 5: its link has no length",
              {"link_length", 5, "", {{"length", 1e-3}}, {}});
}

void a_drift_by_temperature_needs_temperatures() {
  MovingRobot moving;
  moving.robot.effects = {
      {"thermal_drift", 0, "temperature", {{"x", 1e-5}, {"y", 0}, {"z", 0}}, {}}};
  TEST_ASSERT_EQUAL_UINT64(1, effects::machine_of(moving.robot, {moving.scene()}).terms.size());
  moving.recording.temperature.reset();
  try {
    effects::machine_of(moving.robot, {moving.scene()});
    TEST_FAIL_MESSAGE("not refused");
  } catch (const InputError& error) {
    TEST_ASSERT_TRUE(std::string(error.what()).find("moving.csv") != std::string::npos);
  }
}

/// By how much an alteration of a machine moves the TCP (n×3, m).
template <typename Alteration>
Eigen::MatrixXd moved_by(const Alteration& alter) {
  const MovingRobot moving;
  const simulation::Scene scene = moving.scene();
  simulation::Machine machine = effects::machine_of(moving.robot, {scene});
  const auto place = [&] {
    return simulation::predict(machine, {scene}).front().channel[simulation::tcp_position];
  };
  const Eigen::MatrixXd before = place();
  alter(&machine);
  return place() - before;
}

Eigen::MatrixXd moved_by(const char* effect, const char* form, const effects::Values& values,
                         int joint) {
  return moved_by([&](simulation::Machine* machine) {
    effects::find_law(effect, form)->apply(values, joint, machine);
  });
}

/// Of the temperature since the first row, as it rises evenly.
Eigen::VectorXd rise() { return MovingRobot().recording.temperature->array() - 20; }

void a_tool_that_grows_moves_the_tcp_along_itself() {
  const Eigen::MatrixXd along = moved_by("thermal_drift", "tool", {1e-5, 0, 0}, 0);
  const Eigen::MatrixXd across = moved_by("thermal_drift", "tool", {0, 1e-5, 0}, 0);
  const Eigen::VectorXd length = along.rowwise().norm();
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (length - 1e-5 * rise().cwiseAbs()).cwiseAbs().maxCoeff());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0,
                            along.cwiseProduct(across).rowwise().sum().cwiseAbs().maxCoeff());
}

/// The lengths beyond a link, before they are weighed anew: the springs notice a thousandth.
void assert_grows_like(const Eigen::MatrixXd& longer, const Eigen::MatrixXd& found) {
  const Eigen::MatrixXd expected = rise().asDiagonal() * longer;
  TEST_ASSERT_TRUE((found - expected).norm() < 0.01 * expected.norm());
}

void a_link_that_grows_is_an_offset_of_the_next_joint_that_grows() {
  for (int joint = 1; joint <= 5; ++joint) {
    const Eigen::Vector3d shift(1e-5, -2e-5, 3e-5);
    const auto lengthen = [&](simulation::Machine* machine) {
      machine->robot.elastic.joints[static_cast<std::size_t>(joint)].origin.position += shift;
    };
    assert_grows_like(moved_by(lengthen),
                      moved_by("thermal_drift", "link", {shift[0], shift[1], shift[2]}, joint));
  }
}

void an_arm_that_grows_alike_has_longer_links() {
  const auto lengthen = [](simulation::Machine* machine) {
    for (auto& joint : machine->robot.elastic.joints) {
      joint.origin.position *= 1 + 1e-5;
    }
  };
  assert_grows_like(moved_by(lengthen), moved_by("thermal_drift", "arm", {1e-5}, 0));
}

void a_model_that_holds_at_a_temperature_drifts_from_there() {
  const auto drift = [](std::optional<double> reference) {
    return moved_by([&](simulation::Machine* machine) {
      machine->robot.reference_temperature = reference;
      effects::find_law("thermal_drift", "temperature")->apply({1e-5, 0, 0}, 0, machine);
    });
  };
  const Eigen::VectorXd difference = (drift(15.0) - drift(std::nullopt)).col(0);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5e-5, difference.minCoeff());
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5e-5, difference.maxCoeff());
}

void a_zero_that_drifts_is_an_offset_that_grows() {
  const Eigen::MatrixXd expected = rise().asDiagonal() * moved_by("joint_offset", "", {1e-5}, 2);
  const Eigen::MatrixXd found = moved_by("thermal_drift", "zero", {1e-5}, 2);
  TEST_ASSERT_TRUE((found - expected).norm() < 0.01 * expected.norm());
}

void play_by_the_key_follows_the_load_where_there_is_any_and_else_the_motion() {
  constexpr double kGap = 3e-4;
  MovingRobot moving;
  moving.robot.dynamics[1].backlash = kGap;
  const simulation::Scene loaded = moving.scene();
  const simulation::Machine keyed = effects::machine_of(moving.robot);
  moving.robot.dynamics[1].backlash = 0;
  simulation::Machine by_load = effects::machine_of(moving.robot);
  effects::find_law("backlash", "load")->apply({kGap, 30}, 2, &by_load);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, difference(keyed, by_load, loaded));

  moving.robot.elastic.gravity.setZero();
  moving.recording.wrench.reset();
  moving.recording.q_link.reset();
  moving.recording.tau.reset();
  const simulation::Scene free = moving.scene();
  simulation::Machine by_motion = effects::machine_of(moving.robot);
  effects::find_law("backlash", "motion")->apply({kGap}, 2, &by_motion);
  moving.robot.dynamics[1].backlash = kGap;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0,
                            difference(effects::machine_of(moving.robot), by_motion, free));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_effect_of_no_size_changes_nothing);
  RUN_TEST(an_effect_that_was_learnt_is_simulated_from_the_file_it_is_written_to);
  RUN_TEST(a_machine_does_not_depend_on_the_order_in_which_its_effects_are_listed);
  RUN_TEST(every_mistake_in_the_list_is_refused_without_a_recording);
  RUN_TEST(a_drift_by_temperature_needs_temperatures);
  RUN_TEST(a_tool_that_grows_moves_the_tcp_along_itself);
  RUN_TEST(a_link_that_grows_is_an_offset_of_the_next_joint_that_grows);
  RUN_TEST(an_arm_that_grows_alike_has_longer_links);
  RUN_TEST(a_model_that_holds_at_a_temperature_drifts_from_there);
  RUN_TEST(a_zero_that_drifts_is_an_offset_that_grows);
  RUN_TEST(play_by_the_key_follows_the_load_where_there_is_any_and_else_the_motion);
  return UNITY_END();
}
