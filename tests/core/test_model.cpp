#include <limits>

#include "core/test_robots.hpp"
#include "unity_main.hpp"

using flexcomp::model_hash;
using flexcomp::Result;
using flexcomp::RobotModel;
using flexcomp::validate;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;

namespace {

using Model = RobotModel<double, 6>;
using Change = void (*)(Model*);

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void complete_models_are_valid() {
  TEST_ASSERT_EQUAL(Result::ok, validate(kr270<double>()));
  TEST_ASSERT_EQUAL(Result::ok, validate(kr270<float>()));
  TEST_ASSERT_EQUAL(Result::ok, validate(kr270_with_everything<double>()));
}

void every_impossible_number_makes_a_model_invalid() {
  const Change changes[] = {
      [](Model* m) { m->joints[0].axis.setZero(); },
      [](Model* m) { m->joints[1].axis *= 1.01; },
      [](Model* m) { m->joints[1].axis.y() = kNan; },
      [](Model* m) { m->joints[2].origin.position.x() = kNan; },
      [](Model* m) { m->joints[3].origin.rotation(0, 0) = 1.1; },
      [](Model* m) { m->joints[3].origin.rotation.row(0) *= -1; },
      [](Model* m) { m->joints[4].lower = m->joints[4].upper; },
      [](Model* m) { m->joints[4].upper = kNan; },
      [](Model* m) { m->joints[4].lower = kNan; },
      [](Model* m) { m->joints[5].compliance = -1e-9; },
      [](Model* m) { m->joints[5].cubic_compliance = kNan; },
      [](Model* m) { m->joints[0].link_compliance[3] = -1e-9; },
      [](Model* m) { m->joints[0].mass = -1; },
      [](Model* m) { m->joints[0].center_of_mass.z() = kNan; },
      [](Model* m) { m->tool.rotation(2, 2) = kNan; },
      [](Model* m) { m->base_compliance[0] = -1e-9; },
      [](Model* m) { m->tool_compliance[5] = kNan; },
      [](Model* m) { m->gravity.x() = std::numeric_limits<double>::infinity(); },
      [](Model* m) { m->payload_mass = -0.1; },
      [](Model* m) { m->payload_center.y() = kNan; },
  };
  for (const Change change : changes) {
    Model model = kr270<double>();
    change(&model);
    TEST_ASSERT_EQUAL(Result::bad_model, validate(model));
  }
}

void a_hardening_spring_is_valid() {
  Model model = kr270<double>();
  model.joints[1].cubic_compliance = -1e-16;
  TEST_ASSERT_EQUAL(Result::ok, validate(model));
}

void host_and_target_precision_have_the_same_hash() {
  TEST_ASSERT_TRUE(model_hash(kr270<double>()) == model_hash(kr270<float>()));
  const Model model = kr270_with_everything<double>();
  TEST_ASSERT_TRUE(model_hash(model) == model_hash(model.cast<float>()));
}

void every_parameter_changes_the_hash() {
  const Change changes[] = {
      [](Model* m) { m->joints[0].origin.position.z() += 1e-4; },
      [](Model* m) { m->joints[5].axis *= -1; },
      [](Model* m) { m->joints[2].lower += 1e-3; },
      [](Model* m) { m->joints[2].upper += 1e-3; },
      [](Model* m) { m->joints[3].compliance *= 1.001; },
      [](Model* m) { m->joints[3].cubic_compliance = 1e-16; },
      [](Model* m) { m->joints[4].link_compliance[2] = 1e-9; },
      [](Model* m) { m->joints[1].mass += 1; },
      [](Model* m) { m->joints[1].center_of_mass.x() += 1e-3; },
      [](Model* m) { m->tool.position.z() += 1e-4; },
      [](Model* m) { m->base_compliance[1] = 1e-9; },
      [](Model* m) { m->tool_compliance[1] = 1e-9; },
      [](Model* m) { m->gravity.z() = -9.81; },
      [](Model* m) { m->payload_mass = 5; },
      [](Model* m) { m->payload_center.z() = 0.1; },
  };
  for (const Change change : changes) {
    Model model = kr270<double>();
    change(&model);
    TEST_ASSERT_FALSE(model_hash(model) == model_hash(kr270<double>()));
  }
}

void the_sign_of_zero_does_not_change_the_hash() {
  Model model = kr270<double>();
  model.gravity.x() = -0.0;
  TEST_ASSERT_TRUE(model_hash(model) == model_hash(kr270<double>()));
}

void springs_and_weights_are_noticed() {
  TEST_ASSERT_FALSE(has_structure_springs(kr270<double>()));
  TEST_ASSERT_FALSE(has_weight(kr270<double>()));
  TEST_ASSERT_TRUE(has_structure_springs(kr270_with_everything<double>()));
  const Change springs[] = {
      [](Model* m) { m->base_compliance[4] = 1e-9; },
      [](Model* m) { m->tool_compliance[0] = 1e-9; },
      [](Model* m) { m->joints[5].link_compliance[2] = 1e-9; },
  };
  for (const Change add : springs) {
    Model model = kr270<double>();
    add(&model);
    TEST_ASSERT_TRUE(has_structure_springs(model));
  }
  TEST_ASSERT_TRUE(has_weight(kr270_with_everything<double>()));
}

void every_result_has_words_of_its_own() {
  for (int i = 0; i <= static_cast<int>(Result::no_table); ++i) {
    for (int j = 0; j < i; ++j) {
      TEST_ASSERT_TRUE(describe(static_cast<Result>(i)) != describe(static_cast<Result>(j)));
    }
  }
  TEST_ASSERT_NOT_NULL(flexcomp::describe(static_cast<Result>(200)));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(complete_models_are_valid);
  RUN_TEST(every_impossible_number_makes_a_model_invalid);
  RUN_TEST(a_hardening_spring_is_valid);
  RUN_TEST(host_and_target_precision_have_the_same_hash);
  RUN_TEST(every_parameter_changes_the_hash);
  RUN_TEST(the_sign_of_zero_does_not_change_the_hash);
  RUN_TEST(springs_and_weights_are_noticed);
  RUN_TEST(every_result_has_words_of_its_own);
  return UNITY_END();
}
