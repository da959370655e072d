#pragma once

#include "flexcomp/compensator.hpp"
#include "milled_circle.hpp"

namespace flexcomp::bench {

template <typename Scalar>
CompensatorInput<Scalar, 6> first_input(const Setpoints<Scalar>& setpoints) {
  return {setpoints.q.front(), Scalar(1e-3), setpoints.wrench.front(), Scalar(1e-3)};
}

/// A compensator with every check, filter and limit on, armed and faded in at the first setpoint.
template <typename Scalar>
Compensator<Scalar, 6> active_compensator(const Table& table, const Setpoints<Scalar>& setpoints) {
  CompensatorConfig<Scalar, 6> config;
  config.period = Scalar(0.004);
  config.model_hash = table.model_hash();
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
  Compensator<Scalar, 6> compensator;
  compensator.configure(config);
  compensator.set_table(table);
  for (int i = 0; i < 500; ++i) {
    compensator.tick(first_input(setpoints));
    compensator.arm();
  }
  return compensator;
}

}  // namespace flexcomp::bench
