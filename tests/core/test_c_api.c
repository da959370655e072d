#include <math.h>
#include <string.h>
#include <unity.h>

#include "flexcomp/flexcomp.h"

void setUp(void) {}
void tearDown(void) {}

static const flexcomp_pose_t identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

/* Two arms of 1 m along x that bend about y; the wrist joints sit at the tip. */
static flexcomp_model_t two_arms(void) {
  flexcomp_model_t model;
  memset(&model, 0, sizeof model);
  model.tool = identity;
  static const float axes[6][3] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0},
                                   {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    model.joints[i].origin = identity;
    memcpy(model.joints[i].axis, axes[i], sizeof axes[i]);
    model.joints[i].lower = -3;
    model.joints[i].upper = 3;
    model.joints[i].compliance = 1e-6f;
  }
  model.joints[2].origin.position[0] = 1;
  model.joints[3].origin.position[0] = 1;
  return model;
}

static uint32_t memory[1 << 14];

static size_t build_table(const flexcomp_model_t* model) {
  const float program[12] = {0, 0, 0.5f, 0.1f, 0.4f, 0, 0.1f, 0.1f, 0.6f, 0.1f, 0.5f, 0};
  const flexcomp_table_requirements_t wanted = {1000, 10, 1e-5f, 1e-5f, 0};
  size_t size = 0;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_build_path(model, program, 2, &wanted, memory,
                                                           sizeof memory, &size));
  return size;
}

static flexcomp_config_t good_config(const flexcomp_model_t* model) {
  flexcomp_config_t config;
  memset(&config, 0, sizeof config);
  config.period = 1e-3f;
  config.model_hash = flexcomp_model_hash(model);
  config.gain = 1;
  config.force_range = 2000;
  config.moment_range = 200;
  config.setpoint_age_limit = 0.01f;
  config.wrench_age_limit = 0.01f;
  config.deflection_limit = 0.01f;
  config.chart_margin = 0.01f;
  config.hold_time = 0.01f;
  config.fade_time = 0.05f;
  config.ready_ticks = 1;
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    config.joint_speed[i] = 10;
    config.limits[i] = (flexcomp_limits_t){0.05f, 1, 100};
  }
  return config;
}

/* 1000 N upwards at 2 m and 1 m: joints 2 and 3 wind up by 2 and 1 mrad, lifting the tip 5 mm. */
static void deflection_follows_from_the_levers(void) {
  const flexcomp_model_t model = two_arms();
  const float q[6] = {0};
  const float wrench[6] = {0, 0, 1000, 0, 0, 0};
  float deflection[6];
  float correction[6];
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_respond(&model, q, wrench, deflection, correction));
  TEST_ASSERT_FLOAT_WITHIN(1e-8f, 5e-3f, deflection[2]);
  TEST_ASSERT_FLOAT_WITHIN(1e-9f, 2e-3f, correction[1]);
  TEST_ASSERT_FLOAT_WITHIN(1e-9f, 1e-3f, correction[2]);
  flexcomp_pose_t tcp;
  float compliance[36];
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_evaluate(&model, q, &tcp, compliance));
  TEST_ASSERT_EQUAL_FLOAT(2, tcp.position[0]);
  TEST_ASSERT_FLOAT_WITHIN(1e-12f, 5e-6f, compliance[2 * 6 + 2]);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_respond(&model, q, wrench, NULL, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_evaluate(&model, q, NULL, NULL));
}

static void a_table_says_what_it_is(void) {
  const flexcomp_model_t model = two_arms();
  const size_t size = build_table(&model);
  flexcomp_table_t table;
  flexcomp_table_info_t info;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_describe(&table, &info));
  TEST_ASSERT_TRUE(info.is_path);
  TEST_ASSERT_TRUE(info.model_hash == flexcomp_model_hash(&model));
  TEST_ASSERT_TRUE(info.size == size);
  TEST_ASSERT_TRUE(info.position_error <= 1e-5f && info.position_error > 0);
  memory[40] ^= 1;
  TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_CORRUPT, flexcomp_table_open(memory, size, &table));
}

/* Whoever makes the checksum anew can copy the fingerprint too. */
static void a_table_whose_springs_are_not_the_models_is_found_out(void) {
  const flexcomp_model_t model = two_arms();
  const size_t size = build_table(&model);
  flexcomp_table_t table;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_check_model(&table, &model));
  flexcomp_model_t other = two_arms();
  other.joints[1].compliance *= 2;
  TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_OTHER_MODEL, flexcomp_table_check_model(&table, &other));
  other.joints[1].compliance = -1;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_MODEL, flexcomp_table_check_model(&table, &other));
  const size_t first_spring = 50; /* word of the header (flexcomp/table.hpp) */
  float* spring = (float*)memory + first_spring + 1;
  TEST_ASSERT_EQUAL_FLOAT(model.joints[1].compliance, *spring);
  *spring *= -5; /* in place: the CRC was looked at when it was opened */
  TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_OTHER_MODEL, flexcomp_table_check_model(&table, &model));
  const flexcomp_table_t none = {0};
  TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_table_check_model(&none, &model));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_check_model(NULL, &model));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_check_model(&table, NULL));
}

/* As a signed table, or one in a sector of flash. */
static void a_table_with_something_behind_it_is_opened_by_its_own_size(void) {
  const flexcomp_model_t model = two_arms();
  const size_t built = build_table(&model);
  static const char signature[24] = "FCS1 and a counter, tag";
  memcpy((char*)memory + built, signature, sizeof signature);
  const size_t places[] = {built, built + sizeof signature, sizeof memory};
  for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
    flexcomp_table_t table;
    size_t size = 0;
    TEST_ASSERT_EQUAL(i == 0 ? FLEXCOMP_OK : FLEXCOMP_TABLE_CORRUPT,
                      flexcomp_table_open(memory, places[i], &table));
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_size(memory, places[i], &size));
    TEST_ASSERT_TRUE(size == built);
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  }
}

static void the_size_of_what_is_no_whole_table_is_not_told(void) {
  const flexcomp_model_t model = two_arms();
  const size_t built = build_table(&model);
  size_t size = 7;
  for (size_t there = 0; there < built; ++there) {
    TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_TRUNCATED, flexcomp_table_size(memory, there, &size));
  }
  TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_MISALIGNED,
                    flexcomp_table_size((const char*)memory + 1, built, &size));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_size(NULL, built, &size));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_size(memory, built, NULL));
  /* Words of the header, wrong one after the other: magic number, version, size, node count. */
  static const struct {
    size_t word;
    flexcomp_result_t result;
  } wrong[] = {{0, FLEXCOMP_TABLE_NOT_A_TABLE},
               {1, FLEXCOMP_TABLE_VERSION},
               {2, FLEXCOMP_TABLE_CORRUPT},
               {10, FLEXCOMP_TABLE_CORRUPT}};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
    memory[wrong[i].word] -= 1;
    TEST_ASSERT_EQUAL(wrong[i].result, flexcomp_table_size(memory, sizeof memory, &size));
    memory[wrong[i].word] += 1;
  }
  memset(memory, 0xFF, 1000); /* flash that was erased */
  TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_NOT_A_TABLE, flexcomp_table_size(memory, 1000, &size));
  TEST_ASSERT_TRUE(size == 7);
}

static void a_compensator_uses_a_table_with_its_index(void) {
  static uint32_t index[64];
  const flexcomp_model_t model = two_arms();
  const size_t size = build_table(&model);
  flexcomp_table_t table;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  const size_t wanted = flexcomp_table_index_size(&table);
  TEST_ASSERT_TRUE(wanted > 0 && wanted <= sizeof index);
  TEST_ASSERT_EQUAL(FLEXCOMP_BUFFER_TOO_SMALL, flexcomp_table_index(&table, index, wanted - 1));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_index(&table, NULL, wanted));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_table_index(NULL, index, wanted));
  TEST_ASSERT_NULL(table.index);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_index(&table, index, wanted));
  TEST_ASSERT_EQUAL_PTR(index, table.index);
  flexcomp_table_t none = {0};
  TEST_ASSERT_EQUAL(0, flexcomp_table_index_size(&none));
  TEST_ASSERT_EQUAL(0, flexcomp_table_index_size(NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_table_index(&none, index, wanted));

  flexcomp_compensator_t compensator;
  const flexcomp_config_t config = good_config(&model);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_init(&compensator, &config));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_set_table(&compensator, &table));
  const flexcomp_input_t input = {{0, 0, 0.5f, 0.1f, 0.4f, 0}, 0, {0, 0, 500, 0, 0, 0}, 0, false};
  flexcomp_output_t output;
  flexcomp_compensator_tick(&compensator, &input, &output);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_arm(&compensator));
  flexcomp_compensator_tick(&compensator, &input, &output);
  TEST_ASSERT_EQUAL_HEX32(0, output.status & FLEXCOMP_FAULT_BITS);
}

static void a_grid_table_can_be_built_too(void) {
  const flexcomp_model_t model = two_arms();
  const float lower[4] = {0, 0.5f, 0, 0.4f};
  const float upper[4] = {0.1f, 0.6f, 0, 0.4f};
  const flexcomp_table_requirements_t wanted = {1000, 10, 2e-5f, 2e-5f, 0};
  size_t size = 0;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_build_grid(&model, lower, upper, &wanted, memory,
                                                           sizeof memory, &size));
  flexcomp_table_t table;
  flexcomp_table_info_t info;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_describe(&table, &info));
  TEST_ASSERT_FALSE(info.is_path);
}

static void a_loop_corrects_fades_and_resets(void) {
  const flexcomp_model_t model = two_arms();
  const size_t size = build_table(&model);
  flexcomp_table_t table;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  flexcomp_compensator_t compensator;
  const flexcomp_config_t config = good_config(&model);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_init(&compensator, &config));
  TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_compensator_arm(&compensator));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_set_table(&compensator, &table));
  flexcomp_input_t input = {{0, 0, 0.5f, 0.1f, 0.4f, 0}, 0, {0, 0, 500, 0, 0, 0}, 0, false};
  flexcomp_output_t output;
  for (int tick = 0; tick < 500; ++tick) {
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_tick(&compensator, &input, &output));
    if (tick == 1) {
      TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_arm(&compensator));
    }
  }
  TEST_ASSERT_EQUAL(FLEXCOMP_STATE_ACTIVE, output.state);
  float expected[6];
  TEST_ASSERT_EQUAL(FLEXCOMP_OK,
                    flexcomp_model_respond(&model, input.setpoint, input.wrench, NULL, expected));
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, expected[i], output.correction[i]);
    TEST_ASSERT_EQUAL_FLOAT(input.setpoint[i] + output.correction[i], output.setpoint[i]);
  }
  input.wrench[0] = NAN;
  for (int tick = 0; tick < 500; ++tick) {
    flexcomp_compensator_tick(&compensator, &input, &output);
  }
  TEST_ASSERT_EQUAL(FLEXCOMP_STATE_LATCHED, output.state);
  TEST_ASSERT_EQUAL_HEX32(FLEXCOMP_WRENCH_NOT_FINITE, output.latched_faults);
  TEST_ASSERT_EQUAL_FLOAT(0, output.correction[1]);
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_reset(&compensator));
  flexcomp_compensator_disarm(&compensator);
}

/* Zero memory, as a static object's, and what a failed init leaves of one that corrected. */
static void a_compensator_without_a_configuration_says_so_in_every_tick(void) {
  const flexcomp_model_t model = two_arms();
  const size_t size = build_table(&model);
  flexcomp_table_t table;
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_table_open(memory, size, &table));
  static flexcomp_compensator_t compensator;
  flexcomp_config_t config = good_config(&model);
  const flexcomp_input_t input = {{0, 0, 0.5f, 0.1f, 0.4f, 0}, 0, {0, 0, 0, 0, 0, 0}, 0, false};
  for (int begun = 0; begun < 2; ++begun) {
    flexcomp_output_t output;
    TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG,
                      flexcomp_compensator_tick(&compensator, &input, &output));
    TEST_ASSERT_EQUAL(FLEXCOMP_STATE_OFF, output.state);
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(input.setpoint, output.setpoint, FLEXCOMP_JOINTS);
    TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_compensator_arm(&compensator));
    TEST_ASSERT_EQUAL(FLEXCOMP_TABLE_OTHER_MODEL,
                      flexcomp_compensator_set_table(&compensator, &table));
    config.gain = 1;
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_init(&compensator, &config));
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_set_table(&compensator, &table));
    TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_tick(&compensator, &input, &output));
    config.gain = 2;
    TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG, flexcomp_compensator_init(&compensator, &config));
  }
}

static void null_pointers_are_refused(void) {
  const flexcomp_model_t model = two_arms();
  const flexcomp_config_t config = good_config(&model);
  const flexcomp_table_requirements_t wanted = {1000, 10, 1e-5f, 1e-5f, 0};
  const float six[6] = {0};
  flexcomp_compensator_t compensator;
  flexcomp_table_t table = {0};
  flexcomp_table_info_t info;
  flexcomp_input_t input = {{0}, 0, {0}, 0, false};
  flexcomp_output_t output;
  size_t size = 0;
  const flexcomp_result_t bad = FLEXCOMP_BAD_ARGUMENT;
  TEST_ASSERT_EQUAL(bad, flexcomp_model_validate(NULL));
  TEST_ASSERT_TRUE(flexcomp_model_hash(NULL) == 0);
  TEST_ASSERT_EQUAL(bad, flexcomp_model_evaluate(NULL, six, NULL, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_evaluate(&model, NULL, NULL, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_respond(NULL, six, six, NULL, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_respond(&model, NULL, six, NULL, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_respond(&model, six, NULL, NULL, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_path(NULL, six, 1, &wanted, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_path(&model, NULL, 2, &wanted, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_path(&model, six, 1, NULL, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_path(&model, six, 1, &wanted, NULL, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_path(&model, six, 1, &wanted, memory, 100, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_grid(NULL, six, six, &wanted, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_grid(&model, NULL, six, &wanted, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_grid(&model, six, NULL, &wanted, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_build_grid(&model, six, six, NULL, memory, 100, &size));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_open(NULL, 100, &table));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_open(memory, 100, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_describe(NULL, &info));
  TEST_ASSERT_EQUAL(bad, flexcomp_table_describe(&table, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_table_describe(&table, &info));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_init(NULL, &config));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_init(&compensator, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_compensator_init(&compensator, &config));
  TEST_ASSERT_EQUAL(FLEXCOMP_NO_TABLE, flexcomp_compensator_set_table(&compensator, &table));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_set_table(&compensator, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_set_table(NULL, &table));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_arm(NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_reset(NULL));
  flexcomp_compensator_disarm(NULL);
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_tick(NULL, &input, &output));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_tick(&compensator, NULL, &output));
  TEST_ASSERT_EQUAL(bad, flexcomp_compensator_tick(&compensator, &input, NULL));
}

static void numbers_that_are_not_finite_are_refused(void) {
  flexcomp_model_t model = two_arms();
  const float q[6] = {0, NAN, 0, 0, 0, 0};
  const float zero[6] = {0};
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_model_evaluate(&model, q, NULL, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_model_respond(&model, zero, q, NULL, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_ARGUMENT, flexcomp_model_respond(&model, q, zero, NULL, NULL));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_validate(&model));
  model.joints[3].compliance = NAN;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_MODEL, flexcomp_model_validate(&model));
  flexcomp_config_t config = good_config(&model);
  config.period = INFINITY;
  flexcomp_compensator_t compensator;
  TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG, flexcomp_compensator_init(&compensator, &config));
}

static void a_model_that_gives_no_number_is_refused(void) {
  const float q[6] = {0};
  const float wrench[6] = {0, 0, 1000, 0, 0, 0};
  flexcomp_model_t model = two_arms();
  model.joints[1].compliance = NAN;
  flexcomp_pose_t tcp;
  float compliance[36] = {7};
  float deflection[6] = {7};
  float correction[6] = {7};
  const flexcomp_result_t bad = FLEXCOMP_BAD_ARGUMENT;
  TEST_ASSERT_EQUAL(bad, flexcomp_model_evaluate(&model, q, NULL, compliance));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_respond(&model, q, wrench, deflection, NULL));
  TEST_ASSERT_EQUAL(bad, flexcomp_model_respond(&model, q, wrench, NULL, correction));
  TEST_ASSERT_EQUAL(FLEXCOMP_OK, flexcomp_model_evaluate(&model, q, &tcp, NULL));
  model.joints[2].origin.position[0] = INFINITY;
  TEST_ASSERT_EQUAL(bad, flexcomp_model_evaluate(&model, q, &tcp, NULL));
  TEST_ASSERT_EQUAL_FLOAT(2, tcp.position[0]);
  TEST_ASSERT_EQUAL_FLOAT(7, compliance[0]);
  TEST_ASSERT_EQUAL_FLOAT(7, deflection[0]);
  TEST_ASSERT_EQUAL_FLOAT(7, correction[0]);
}

static void a_number_of_a_model_that_is_refused_is_named(void) {
  flexcomp_model_t model = two_arms();
  size_t joint = 0;
  TEST_ASSERT_NULL(flexcomp_model_unusable_member(&model, &joint));
  TEST_ASSERT_EQUAL(FLEXCOMP_JOINTS, joint);
  TEST_ASSERT_NULL(flexcomp_model_unusable_member(NULL, &joint));
  TEST_ASSERT_EQUAL(FLEXCOMP_JOINTS, joint);
  flexcomp_joint_t* third = &model.joints[2];
  const struct {
    float* number;
    float bad;
    const char* name;
    size_t joint;
  } members[] = {{&third->origin.rotation[4], 1.1f, "origin", 2},
                 {&third->origin.position[1], NAN, "origin", 2},
                 {&third->axis[1], 1.001f, "axis", 2},
                 {&third->lower, -INFINITY, "lower", 2},
                 {&third->upper, -3, "upper", 2},
                 {&third->compliance, -1e-9f, "compliance", 2},
                 {&third->cubic_compliance, NAN, "cubic_compliance", 2},
                 {&third->link_compliance[5], -1, "link_compliance", 2},
                 {&third->mass, -1, "mass", 2},
                 {&third->center_of_mass[0], INFINITY, "center_of_mass", 2},
                 {&model.tool.rotation[0], -1, "tool", FLEXCOMP_JOINTS},
                 {&model.base_compliance[0], -1, "base_compliance", FLEXCOMP_JOINTS},
                 {&model.tool_compliance[3], NAN, "tool_compliance", FLEXCOMP_JOINTS},
                 {&model.gravity[2], NAN, "gravity", FLEXCOMP_JOINTS},
                 {&model.payload_mass, -1, "payload_mass", FLEXCOMP_JOINTS},
                 {&model.payload_center[1], NAN, "payload_center", FLEXCOMP_JOINTS}};
  for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
    const float good = *members[i].number;
    *members[i].number = members[i].bad;
    TEST_ASSERT_EQUAL(FLEXCOMP_BAD_MODEL, flexcomp_model_validate(&model));
    TEST_ASSERT_EQUAL_STRING(members[i].name, flexcomp_model_unusable_member(&model, &joint));
    TEST_ASSERT_EQUAL(members[i].joint, joint);
    TEST_ASSERT_EQUAL_STRING(members[i].name, flexcomp_model_unusable_member(&model, NULL));
    *members[i].number = good;
  }
}

/* 1e-9 s makes more periods of a fade than can be; in 2 s no rate is near what is gained. */
static void a_period_that_no_loop_has_is_named_rather_than_what_it_makes_unusable(void) {
  const flexcomp_model_t model = two_arms();
  flexcomp_config_t config = good_config(&model);
  static const float periods[] = {1e-9f, 2};
  for (size_t i = 0; i < 2; ++i) {
    config.period = periods[i];
    TEST_ASSERT_EQUAL_STRING("period", flexcomp_config_unusable_member(&config));
    config.limits[2].rate = 0;
    TEST_ASSERT_EQUAL_STRING(i == 0 ? "fade_time" : "limits",
                             flexcomp_config_unusable_member(&config));
    config.limits[2].rate = 1;
  }
  config.period = 0.9f; /* acceleration × period / 64 is more than the rate */
  TEST_ASSERT_EQUAL_STRING("limits", flexcomp_config_unusable_member(&config));
}

static void a_number_that_is_refused_is_named(void) {
  flexcomp_model_t model = two_arms();
  flexcomp_config_t config = good_config(&model);
  TEST_ASSERT_NULL(flexcomp_config_unusable_member(&config));
  TEST_ASSERT_NULL(flexcomp_config_unusable_member(NULL));
  struct {
    float* number;
    float bad;
    const char* name;
  } members[] = {{&config.period, 0, "period"},
                 {&config.gain, 1.5f, "gain"},
                 {&config.filter_cutoff, -1, "filter_cutoff"},
                 {&config.force_range, 0, "force_range"},
                 {&config.moment_range, 1e30f, "moment_range"},
                 {&config.setpoint_age_limit, NAN, "setpoint_age_limit"},
                 {&config.wrench_age_limit, 0, "wrench_age_limit"},
                 {&config.joint_speed[4], 0, "joint_speed"},
                 {&config.deflection_limit, -1, "deflection_limit"},
                 {&config.chart_margin, INFINITY, "chart_margin"},
                 {&config.hold_time, 2e6f, "hold_time"},
                 {&config.fade_time, 2e3f, "fade_time"},
                 {&config.limits[5].rate, 0, "limits"}};
  for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
    const float good = *members[i].number;
    *members[i].number = members[i].bad;
    flexcomp_compensator_t compensator;
    TEST_ASSERT_EQUAL(FLEXCOMP_BAD_CONFIG, flexcomp_compensator_init(&compensator, &config));
    TEST_ASSERT_EQUAL_STRING(members[i].name, flexcomp_config_unusable_member(&config));
    *members[i].number = good;
  }
}

static void everything_has_words(void) {
  TEST_ASSERT_EQUAL_STRING("ok", flexcomp_describe_result(FLEXCOMP_OK));
  TEST_ASSERT_EQUAL_STRING("active", flexcomp_describe_state(FLEXCOMP_STATE_ACTIVE));
  TEST_ASSERT_EQUAL_STRING("wrench stale", flexcomp_describe_status_bit(FLEXCOMP_WRENCH_STALE));
  TEST_ASSERT_NOT_NULL(strchr(flexcomp_version(), '.'));
}

int main(void) {
  UNITY_BEGIN();
  RUN_TEST(deflection_follows_from_the_levers);
  RUN_TEST(a_table_says_what_it_is);
  RUN_TEST(a_table_whose_springs_are_not_the_models_is_found_out);
  RUN_TEST(a_table_with_something_behind_it_is_opened_by_its_own_size);
  RUN_TEST(the_size_of_what_is_no_whole_table_is_not_told);
  RUN_TEST(a_compensator_uses_a_table_with_its_index);
  RUN_TEST(a_grid_table_can_be_built_too);
  RUN_TEST(a_loop_corrects_fades_and_resets);
  RUN_TEST(a_compensator_without_a_configuration_says_so_in_every_tick);
  RUN_TEST(null_pointers_are_refused);
  RUN_TEST(numbers_that_are_not_finite_are_refused);
  RUN_TEST(a_model_that_gives_no_number_is_refused);
  RUN_TEST(a_number_of_a_model_that_is_refused_is_named);
  RUN_TEST(a_period_that_no_loop_has_is_named_rather_than_what_it_makes_unusable);
  RUN_TEST(a_number_that_is_refused_is_named);
  RUN_TEST(everything_has_words);
  return UNITY_END();
}
