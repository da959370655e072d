#include <flexcomp/flexcomp.h>
#include <stdio.h>

/* A KUKA KR 270: joint origins (m), axes, limits (rad) and joint springs (rad/(N·m)). */
static flexcomp_model_t kr270(void) {
  static const float origin[6][3] = {{0, 0, 0.75f},   {0.35f, 0, 0}, {1.25f, 0, 0},
                                     {0, 0, -0.055f}, {1.1f, 0, 0},  {0.23f, 0, 0}};
  static const float axis[6][3] = {{0, 0, -1}, {0, 1, 0}, {0, 1, 0},
                                   {-1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  static const float limit[6][2] = {{-3.2f, 3.2f}, {-2.5f, 0},    {-2.0f, 2.7f},
                                    {-6.1f, 6.1f}, {-2.1f, 2.1f}, {-6.1f, 6.1f}};
  static const float compliance[6] = {0.54e-6f, 0.29e-6f, 0.42e-6f, 2.79e-6f, 3.48e-6f, 2.07e-6f};
  static const flexcomp_pose_t identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  flexcomp_model_t model = {0};
  model.tool = identity;
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    flexcomp_joint_t* joint = &model.joints[i];
    joint->origin = identity;
    for (int k = 0; k < 3; ++k) {
      joint->origin.position[k] = origin[i][k];
      joint->axis[k] = axis[i][k];
    }
    joint->lower = limit[i][0];
    joint->upper = limit[i][1];
    joint->compliance = compliance[i];
  }
  return model;
}

/* The program: the shoulder swings by 0.2 rad in 2 s. */
static void setpoint_at(int tick, float q[FLEXCOMP_JOINTS]) {
  static const float start[FLEXCOMP_JOINTS] = {0, -1.2f, 1.4f, 0, 0.6f, 0};
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    q[i] = start[i];
  }
  q[1] += 0.2f * (float)tick / 2000.0f;
}

static uint32_t table_memory[4096]; /* on a controller: a file in flash, made by `flexcomp table` */

int main(void) {
  const flexcomp_model_t model = kr270();
  float program[2][FLEXCOMP_JOINTS];
  setpoint_at(0, program[0]);
  setpoint_at(2000, program[1]);
  const flexcomp_table_requirements_t wanted = {1600, 20, 2e-6f, 2e-6f, 0};
  size_t size = 0;
  flexcomp_result_t result = flexcomp_table_build_path(&model, &program[0][0], 2, &wanted,
                                                       table_memory, sizeof table_memory, &size);
  flexcomp_table_t table = {0};
  if (result == FLEXCOMP_OK) {
    result = flexcomp_table_open(table_memory, size, &table);
  }

  flexcomp_config_t config = {
      .period = 1e-3f,
      .model_hash = flexcomp_model_hash(&model),
      .gain = 1,
      .filter_cutoff = 50,
      .force_range = 5000,
      .moment_range = 500,
      .setpoint_age_limit = 4e-3f,
      .wrench_age_limit = 10e-3f,
      .deflection_limit = 5e-3f,
      .chart_margin = 0.02f,
      .hold_time = 0.05f,
      .fade_time = 0.5f,
      .ready_ticks = 10,
  };
  for (int i = 0; i < FLEXCOMP_JOINTS; ++i) {
    config.joint_speed[i] = 2;
    config.limits[i] = (flexcomp_limits_t){.value = 0.01f, .rate = 0.1f, .acceleration = 5};
  }
  static flexcomp_compensator_t compensator;
  if (result == FLEXCOMP_OK) {
    result = flexcomp_compensator_init(&compensator, &config);
  }
  if (result == FLEXCOMP_OK) {
    result = flexcomp_compensator_set_table(&compensator, &table);
  }
  if (result != FLEXCOMP_OK) {
    printf("cannot start: %s\n", flexcomp_describe_result(result));
    return 1;
  }

  flexcomp_output_t output = {0};
  for (int tick = 0; tick < 2000; ++tick) { /* once every millisecond */
    flexcomp_input_t input = {
        .setpoint_age = 1e-3f, .wrench = {440, 1370, 635, 0, 3, 10.5f}, .wrench_age = 1e-3f};
    setpoint_at(tick, input.setpoint);
    flexcomp_compensator_tick(&compensator, &input, &output);
    if (tick == 100) {
      flexcomp_compensator_arm(&compensator);
    }
    /* send output.setpoint to the drives; log output.status */
  }
  printf("%s: TCP would be off by %.0f, %.0f, %.0f um; joint 2 corrected by %.1f urad\n",
         flexcomp_describe_state(output.state), 1e6 * (double)output.deflection[0],
         1e6 * (double)output.deflection[1], 1e6 * (double)output.deflection[2],
         1e6 * (double)output.correction[1]);
  return output.state == FLEXCOMP_STATE_ACTIVE ? 0 : 1;
}
