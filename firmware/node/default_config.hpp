#pragma once

#include "node/node.hpp"

namespace flexcomp {

/// The compensator's part of `default_node_config`, in any precision.
template <typename Scalar>
CompensatorConfig<Scalar, 6> default_compensator_config() {
  CompensatorConfig<Scalar, 6> config;
  config.period = Scalar(0.004);
  config.filter_cutoff = 20;
  config.force_range = 6000;
  config.moment_range = 600;
  config.setpoint_age_limit = Scalar(0.02);
  config.wrench_age_limit = Scalar(0.02);
  config.joint_speed.setConstant(Scalar(1.5));
  config.limits.fill({Scalar(0.01), Scalar(0.1), Scalar(5)});
  config.deflection_limit = Scalar(0.005);
  config.chart_margin = Scalar(0.02);
  config.hold_time = Scalar(0.05);
  config.fade_time = Scalar(0.5);
  return config;
}

/// Limits that suit a heavy machining robot on a 4 ms cycle, for a user to start from. The model
/// hash is left zero; joint speeds are 1.5 rad/s.
NodeConfig default_node_config();

}  // namespace flexcomp
