#pragma once

#include <vector>

#include "hil/faults/injections.hpp"

/// Messages that arrive whole and in time, and say what cannot be.
namespace flexcomp::test {

inline std::vector<Fault> faults_of_setpoints() {
  const auto fault = [](int number, const char* what, Reaction reaction, Injection inject) {
    return Fault{number, "setpoint", what, reaction, std::move(inject)};
  };
  return {
      fault(6, "stuck: the robot stands", Reaction::goes_on, standing_still()),
      fault(8, "wrong: degrees instead of radians", Reaction::zero, in_degrees())
          .told_by(kSetpointNotFinite | kSetpointOutOfRange),
      fault(8, "wrong: 0.3 rad off", Reaction::zero, off_by(0.3))
          .told_by(kSetpointJump | kOutsideChart),
      fault(8, "garbage: random angles, protected", Reaction::zero, random_angles())
          .told_by(kSetpointJump | kOutsideChart),
      fault(15, "leaves the table within the margin", Reaction::goes_on, leaving_by(0.01 / 30, 30))
          .told_by(kChartEdge),
      fault(15, "leaves the table", Reaction::zero, leaving_by(0.002, 50)).told_by(kOutsideChart),
  };
}

inline std::uint64_t implausible_samples(const NodeOnABus& bus) {
  return bus.node.wrench_monitor().implausible_samples();
}

inline std::uint64_t saturated_samples(const NodeOnABus& bus) {
  return bus.node.wrench_monitor().saturated_samples();
}

inline std::vector<Fault> faults_of_wrenches() {
  const auto fault = [](int number, const char* what, Reaction reaction, Injection inject) {
    return Fault{number, "wrench", what, reaction, std::move(inject)};
  };
  return {
      fault(6, "stuck: the same bits while the robot moves", Reaction::zero,
            repeating_the_first_wrench())
          .told_by(kWrenchStuck)
          .where([](NodeConfig* config) { config->wrench.stuck_time = 0.1; }),
      fault(7, "denormal numbers, CAN FD", Reaction::goes_on, with_a_denormal_moment()).over_fd(),
      fault(8, "wrong: newtons times 1000", Reaction::zero, times(1000))
          .told_by(kWrenchNotFinite | kWrenchOutOfRange),
      fault(8, "garbage: random values, protected", Reaction::zero, random_wrenches())
          .told_by(kWrenchOutOfRange)
          .told_by(kWrenchImplausible)
          .counted_by(implausible_samples)
          .where([](NodeConfig* config) {
            config->wrench.force_rate = 1e5;
            config->wrench.moment_rate = 1e4;
          }),
      fault(8, "wrong: sign turned (a jump of 2.9 kN)", Reaction::goes_on, times(-1))
          .told_by(kWrenchImplausible)
          .counted_by(implausible_samples)
          .where([](NodeConfig* config) { config->wrench.force_rate = 2e5; }),
      fault(9, "saturated: three samples", Reaction::goes_on, saturated(3))
          .told_by(kWrenchSaturated)
          .counted_by(saturated_samples),
      fault(9, "saturated: all", Reaction::zero, saturated(kAll))
          .told_by(kWrenchStale)
          .told_by(kWrenchSaturated)
          .counted_by(saturated_samples),
      fault(16, "the correction grows above its limit at the TCP", Reaction::goes_on, times(1))
          .told_by(kDeflectionLimited)
          .where([](NodeConfig* config) { config->compensator.deflection_limit = 2e-4F; }),
      fault(16, "the predicted deflection passes the warning", Reaction::goes_on,
            growing_by(0.01, 20))
          .told_by(kDeflectionWarning)
          .where([](NodeConfig* config) { config->deflection_warning = 0.0035; }),
      fault(16, "the predicted deflection passes the error limit", Reaction::zero,
            growing_by(0.02, 100))
          .told_by(kDeflectionTooLarge)
          .where([](NodeConfig* config) { config->deflection_error = 0.005; }),
      fault(16, "the correction is asked to move too fast", Reaction::goes_on,
            in_and_out_of_the_cut())
          .told_by(kRateLimited),
  };
}

}  // namespace flexcomp::test
