#include <flexcomp/flexcomp.h>
#include <stdio.h>

/* The bytes of t.fct, at a multiple of 4; on a controller they lie in flash. */
_Alignas(4) static const unsigned char table_bytes[] = {
#include "table.inc"
};

static flexcomp_compensator_t compensator;

/* At start. `model_hash`: the number in node.toml, written by flexcomp configure. */
static flexcomp_result_t start(uint64_t model_hash) {
  flexcomp_config_t config = {
      .period = 4e-3f,
      .model_hash = model_hash,
      .gain = 1,
      .filter_cutoff = 20,
      .force_range = 6000,
      .moment_range = 600,
      .setpoint_age_limit = 20e-3f,
      .wrench_age_limit = 20e-3f,
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
  static flexcomp_table_t table;
  size_t size = 0; /* the table's: a signature or the rest of a sector may lie behind it */
  flexcomp_result_t result = flexcomp_table_size(table_bytes, sizeof table_bytes, &size);
  if (result == FLEXCOMP_OK) {
    result = flexcomp_table_open(table_bytes, size, &table);
  }
  if (result == FLEXCOMP_OK) {
    result = flexcomp_compensator_init(&compensator, &config);
  }
  return result == FLEXCOMP_OK ? flexcomp_compensator_set_table(&compensator, &table) : result;
}

int main(void) {
  const flexcomp_result_t result = start(MODEL_HASH);
  printf("%s\n", flexcomp_describe_result(result));
  return result == FLEXCOMP_OK ? 0 : 1;
}
