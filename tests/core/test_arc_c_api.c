#include <math.h>
#include <string.h>
#include <unity.h>

#include "flexcomp/flexcomp.h"

void setUp(void) {}
void tearDown(void) {}

/* Three upright arms of 10 kg at 0.5 m that bend about y; joints 4 to 6 carry nothing. */
static flexcomp_model_t three_arms(void) {
  flexcomp_model_t model;
  memset(&model, 0, sizeof model);
  const flexcomp_pose_t identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  model.tool = identity;
  model.gravity[2] = -9.81f;
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    model.joints[i].origin = identity;
    model.joints[i].origin.position[0] = i > 0 && i < 4 ? 1.0f : 0.0f;
    model.joints[i].axis[1] = -1;
    model.joints[i].lower = -3;
    model.joints[i].upper = 3;
    model.joints[i].compliance = 1e-5f;
    model.joints[i].mass = i < 3 ? 10.0f : 0.0f;
    model.joints[i].center_of_mass[0] = 0.5f;
  }
  return model;
}

static flexcomp_arc_gains_t some_gains(void) {
  flexcomp_arc_gains_t gains;
  memset(&gains, 0, sizeof gains);
  gains.period = 1e-3f;
  gains.link_damping = 40;
  gains.motor_damping = 250;
  gains.filter_frequency = 600;
  gains.leak = 5;
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    gains.rotor_inertia[i] = 1;
    gains.viscous[i] = 5;
    gains.link_rate[i] = 15;
    gains.motor_rate[i] = 100;
    gains.motor_stiffness[i] = 5000;
    gains.link_gain[i] = gains.motor_gain[i] = 0.02f;
    gains.link_gain_limit[i] = gains.motor_gain_limit[i] = 100;
    gains.link_bound_limit[i] = gains.motor_bound_limit[i] = 80;
    gains.torque_limit[i] = 1000;
    for (int m = 0; m < 3; ++m) {
      gains.link_adaptation[i][m] = 10;
    }
    for (int m = 0; m < 4; ++m) {
      gains.motor_adaptation[i][m] = 10;
    }
  }
  return gains;
}

static const float inertia[FLEXCOMP_JOINTS][9] = {
    {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static flexcomp_arc_t arc;

/* At rest with the springs carrying the weight, the motors are asked for the weight. */
static void at_rest_the_motors_carry_the_weight(void) {
  const flexcomp_model_t model = three_arms();
  const flexcomp_arc_gains_t gains = some_gains();
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_arc_init(&arc, &model, inertia, &gains));
  const float weight[FLEXCOMP_JOINTS] = {10 * 9.81f * 4.5f, 10 * 9.81f * 2, 10 * 9.81f * 0.5f};
  flexcomp_arc_input_t input;
  memset(&input, 0, sizeof input);
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    input.motor[i] = 1e-5f * weight[i];
  }
  flexcomp_arc_output_t output;
  for (int k = 0; k < 100; ++k) {
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_arc_tick(&arc, &input, &output));
    TEST_ASSERT_EQUAL_UINT32(0, output.status);
    for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
      TEST_ASSERT_FLOAT_WITHIN(0.05f, weight[i], output.torque[i]);
    }
  }
  input.wanted[1] = NAN;
  const float before = output.torque[0];
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_arc_tick(&arc, &input, &output));
  TEST_ASSERT_EQUAL_UINT32(FLEXCOMP_ARC_INPUT_NOT_FINITE, output.status);
  TEST_ASSERT_EQUAL_FLOAT(before, output.torque[0]);
  flexcomp_arc_restart(&arc);
}

static void what_cannot_be_used_is_refused(void) {
  flexcomp_model_t model = three_arms();
  flexcomp_arc_gains_t gains = some_gains();
  flexcomp_arc_input_t input;
  memset(&input, 0, sizeof input);
  flexcomp_arc_output_t output;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_init(NULL, &model, inertia, &gains));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_init(&arc, NULL, inertia, &gains));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_init(&arc, &model, NULL, &gains));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_init(&arc, &model, inertia, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_tick(NULL, &input, &output));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_tick(&arc, NULL, &output));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_arc_tick(&arc, &input, NULL));
  flexcomp_arc_restart(NULL);
  gains.leak = 0;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG, flexcomp_arc_init(&arc, &model, inertia, &gains));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_arc_tick(&arc, &input, &output));
  TEST_ASSERT_EQUAL_UINT32(FLEXCOMP_ARC_NOT_CONFIGURED, output.status);
  gains = some_gains();
  model.joints[3].compliance = 0;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_MODEL, flexcomp_arc_init(&arc, &model, inertia, &gains));
  TEST_ASSERT_EQUAL_STRING("limited in torque",
                           flexcomp_describe_arc_status_bit(FLEXCOMP_ARC_TORQUE_LIMITED));
}

int main(void) {
  UNITY_BEGIN();
  RUN_TEST(at_rest_the_motors_carry_the_weight);
  RUN_TEST(what_cannot_be_used_is_refused);
  return UNITY_END();
}
