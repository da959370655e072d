#pragma once

#include "flexcomp/compensator.hpp"
#include "milled_circle.hpp"
#include "node/default_config.hpp"

namespace flexcomp::bench {

template <typename Scalar>
CompensatorInput<Scalar, 6> first_input(const Setpoints<Scalar>& setpoints) {
  return {setpoints.q.front(), Scalar(1e-3), setpoints.wrench.front(), Scalar(1e-3)};
}

/// A compensator with every check, filter and limit on, armed and faded in at the first setpoint.
template <typename Scalar>
Compensator<Scalar, 6> active_compensator(const Table& table, const Setpoints<Scalar>& setpoints) {
  CompensatorConfig<Scalar, 6> config = default_compensator_config<Scalar>();
  config.model_hash = table.model_hash();
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
