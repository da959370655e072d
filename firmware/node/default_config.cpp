#include "node/default_config.hpp"

namespace flexcomp {

NodeConfig default_node_config() {
  NodeConfig config;
  auto& core = config.compensator;
  core.period = 0.004F;
  core.filter_cutoff = 20;
  core.force_range = 6000;
  core.moment_range = 600;
  core.setpoint_age_limit = 0.02F;
  core.wrench_age_limit = 0.02F;
  core.joint_speed.setConstant(1.5F);
  core.limits.fill({0.01F, 0.1F, 5.0F});
  core.deflection_limit = 0.005F;
  core.chart_margin = 0.02F;
  core.hold_time = 0.05F;
  core.fade_time = 0.5F;
  config.deflection_warning = 0.004;
  config.deflection_error = 0.006;
  config.wrench.stuck_time = 0.5;
  return config;
}

}  // namespace flexcomp
