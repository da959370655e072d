/// Instructions of a call, counted by Valgrind's callgrind: those of bench_tick, on the same
/// circle.
///
///   valgrind --tool=callgrind --instr-atstart=no bench_instructions
///
/// dumps a count for each, named as it is here, over all setpoints; prints how many these are.
#include <valgrind/callgrind.h>

#include <cstdio>

#include "kdl_arm.hpp"
#include "milled_circle.hpp"
#include "pinocchio_arm.hpp"
#include "walking_compensator.hpp"

using namespace flexcomp;
using namespace flexcomp::bench;

namespace {

/// Keeps a result from being optimised away.
template <typename Result>
void use(const Result& result) {
  asm volatile("" : : "r,m"(result) : "memory");
}

template <typename Scalar, typename Once>
void count(const char* name, const Setpoints<Scalar>& setpoints, const Once& once) {
  use(once(setpoints.q.front(), setpoints.wrench.front()));  // the first call links libraries
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    use(once(setpoints.q[i], setpoints.wrench[i]));
  }
  CALLGRIND_DUMP_STATS_AT(name);
  CALLGRIND_STOP_INSTRUMENTATION;
}

void count_core(const MilledCircle& circle, const Table& table) {
  const Setpoints<float> setpoints = in_single_precision(circle.setpoints);
  const RobotModel<float, 6> robot = circle.robot.cast<float>();
  const Compliance<float> compliance =
      tcp_compliance(robot, forward_kinematics<float, 6>(robot, setpoints.q.front()));
  TableCursor cursor;
  Compensator<float, 6> compensator = active_compensator(table, setpoints);
  CompensatorInput<float, 6> input = first_input(setpoints);
  count("floor", setpoints, [&](const auto&, const auto& wrench) {
    return Twist<float>(compliance.lazyProduct(wrench));
  });
  count("look_up", setpoints, [&](const auto& q, const auto& wrench) {
    float outside = 0;
    return look_up_response<float, 6>(table, q, wrench, &cursor, &outside);
  });
  count("tick", setpoints, [&](const auto& q, const auto& wrench) {
    input.setpoint = q;
    input.wrench = wrench;
    return compensator.tick(input);
  });
  count("direct", setpoints, [&](const auto& q, const auto& wrench) {
    return deflection<float, 6>(robot, q, wrench).tcp;
  });
}

void count_peers(const MilledCircle& circle) {
  PinocchioArm pinocchio(circle.robot, 6);
  KdlArm kdl(circle.robot);
  count("pinocchio", circle.setpoints,
        [&](const auto& q, const auto& wrench) { return pinocchio.tcp_deflection(q, wrench); });
  count("kdl", circle.setpoints,
        [&](const auto& q, const auto& wrench) { return kdl.deflection(q, wrench); });
}

}  // namespace

int main() {
  const MilledCircle circle = milled_circle();
  const auto words = path_table(circle, 1e-6);
  count_core(circle, opened(words));
  count_peers(circle);
  std::printf("%zu\n", circle.setpoints.size());
  return 0;
}
