/// Cost of a corrected setpoint in a control loop: the look-up with its deflection and the whole
/// guarded tick, beside the same deflection computed from the model, by flexcomp, Pinocchio and
/// Orocos KDL, and beside the floor: one 6×6 matrix times a vector, both in the nearest cache.
/// Every benchmark walks along a milled circle; `s` is the time of one call.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "flexcomp/compensator.hpp"
#include "kdl_arm.hpp"
#include "milled_circle.hpp"
#include "pinocchio_arm.hpp"
#include "walking_compensator.hpp"

using namespace flexcomp;
using namespace flexcomp::bench;

namespace {

constexpr double kTolerance = 1e-6;  // m, rad

const MilledCircle& circle() {
  static const MilledCircle made = milled_circle();
  return made;
}

template <typename Scalar>
const Setpoints<Scalar>& setpoints() {
  if constexpr (std::is_same_v<Scalar, float>) {
    static const Setpoints<float> made = in_single_precision(circle().setpoints);
    return made;
  } else {
    return circle().setpoints;
  }
}

/// Calls `once` with each setpoint in turn, round after round.
template <typename Scalar, typename Once>
void walk(benchmark::State& state, const Setpoints<Scalar>& along, const Once& once) {
  for (auto _ : state) {
    for (std::size_t i = 0; i < along.size(); ++i) {
      benchmark::DoNotOptimize(once(along.q[i], along.wrench[i]));
    }
  }
  state.counters["s"] = benchmark::Counter(
      static_cast<double>(along.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <typename Scalar>
void floor_of_all(benchmark::State& state) {
  const JointVector<double, 6>& q = circle().program.front();
  const Compliance<Scalar> compliance =
      tcp_compliance(circle().robot, forward_kinematics(circle().robot, q)).cast<Scalar>();
  walk(state, setpoints<Scalar>(), [&](const auto&, const Wrench<Scalar>& wrench) {
    return Twist<Scalar>(compliance.lazyProduct(wrench));
  });
}

template <typename Scalar>
void look_up(benchmark::State& state) {
  const auto words = path_table(circle(), std::pow(10.0, -static_cast<double>(state.range(0))));
  const Table table = opened(words);
  TableCursor cursor;
  walk(state, setpoints<Scalar>(), [&](const auto& q, const auto& wrench) {
    Scalar outside = 0;
    return look_up_response<Scalar, 6>(table, q, wrench, &cursor, &outside);
  });
  state.counters["nodes"] = table.header().node_count;
}

/// Each call looks into another copy of the table, of so many that none stays near.
void look_up_cold(benchmark::State& state) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const auto words = path_table(circle(), kTolerance);
  const std::size_t copies = kBytes / (4 * words.size());
  std::vector<std::uint32_t> all;
  std::vector<Table> tables;
  for (std::size_t i = 0; i < copies; ++i) {
    all.insert(all.end(), words.begin(), words.end());
  }
  for (std::size_t i = 0; i < copies; ++i) {
    tables.emplace_back();
    Table::open(all.data() + i * words.size(), 4 * words.size(), &tables.back());
  }
  TableCursor cursor;
  std::size_t next = 0;
  walk(state, setpoints<float>(), [&](const auto& q, const auto& wrench) {
    float outside = 0;
    // A stride that has no divisor in common with most counts, and that no prefetcher follows.
    next = (next + 7919) % copies;
    return look_up_response<float, 6>(tables[next], q, wrench, &cursor, &outside);
  });
}

/// A grid over so many of the joints 2 to 5, the look-ups all about inside it.
void grid_look_up(benchmark::State& state) {
  const JointVector<double, 6> middle = circle().program.front();
  GridRange<double> ranges[4];
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double half = i < state.range(0) ? 0.05 : 0.0;
    ranges[i] = {middle[i + 1] - half, middle[i + 1] + half};
  }
  const auto words = grid_table(circle().robot, ranges, 1e-4);
  const Table table = opened(words);
  Setpoints<float> along = setpoints<float>();
  for (std::size_t k = 0; k < along.size(); ++k) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double turn = 0.002 * static_cast<double>(k) * static_cast<double>(i + 1);
      const double half = (ranges[i].upper - ranges[i].lower) / 2;
      along.q[k][i + 1] = static_cast<float>(middle[i + 1] + 0.99 * half * std::sin(turn));
    }
  }
  walk(state, along, [&](const auto& q, const auto& wrench) {
    float outside = 0;
    return look_up_response<float, 6>(table, q, wrench, nullptr, &outside);
  });
  state.counters["nodes"] = table.header().node_count;
}

template <typename Scalar>
void tick(benchmark::State& state) {
  const auto words = path_table(circle(), kTolerance);
  Compensator<Scalar, 6> compensator = active_compensator(opened(words), setpoints<Scalar>());
  CompensatorInput<Scalar, 6> input = first_input(setpoints<Scalar>());
  bool always_active = true;
  walk(state, setpoints<Scalar>(), [&](const auto& q, const auto& wrench) {
    input.setpoint = q;
    input.wrench = wrench;
    const CompensatorOutput<Scalar, 6> output = compensator.tick(input);
    always_active &= output.state == State::active;
    return output;
  });
  if (!always_active) {
    state.SkipWithError("the compensator was not active all the time");
  }
}

template <typename Scalar>
void direct(benchmark::State& state) {
  const RobotModel<Scalar, 6> robot = circle().robot.cast<Scalar>();
  walk(state, setpoints<Scalar>(), [&](const auto& q, const auto& wrench) {
    return deflection<Scalar, 6>(robot, q, wrench).tcp;
  });
}

void pinocchio_direct(benchmark::State& state) {
  PinocchioArm arm(circle().robot, 6);
  walk(state, setpoints<double>(),
       [&](const auto& q, const auto& wrench) { return arm.tcp_deflection(q, wrench); });
}

void kdl_direct(benchmark::State& state) {
  KdlArm arm(circle().robot);
  walk(state, setpoints<double>(),
       [&](const auto& q, const auto& wrench) { return arm.deflection(q, wrench); });
}

/// Largest distances from the deflection by flexcomp's model along the circle, m.
struct Disagreement {
  double pinocchio = 0;
  double kdl = 0;
  double table = 0;
};

Disagreement disagreement() {
  PinocchioArm pinocchio(circle().robot, 6);
  KdlArm kdl(circle().robot);
  const auto words = path_table(circle(), kTolerance);
  const Table table = opened(words);
  TableCursor cursor;
  Disagreement most;
  for (std::size_t i = 0; i < circle().setpoints.size(); ++i) {
    const JointVector<double, 6>& q = circle().setpoints.q[i];
    const Wrench<double>& wrench = circle().setpoints.wrench[i];
    const Twist<double> exact = deflection<double, 6>(circle().robot, q, wrench).tcp;
    float outside = 0;
    const auto found = look_up_response<float, 6>(table, setpoints<float>().q[i],
                                                  setpoints<float>().wrench[i], &cursor, &outside);
    const auto from = [&exact](const Twist<double>& other) {
      return (other - exact).head<3>().norm();
    };
    most.pinocchio = std::max(most.pinocchio, from(pinocchio.tcp_deflection(q, wrench)));
    most.kdl = std::max(most.kdl, from(kdl.deflection(q, wrench)));
    most.table = std::max(most.table, from(found.deflection.cast<double>()));
  }
  return most;
}

bool all_agree() {
  const Disagreement most = disagreement();
  std::fprintf(stderr,
               "off flexcomp's model by up to: Pinocchio %.1e m, KDL %.1e m, table %.1e m\n",
               most.pinocchio, most.kdl, most.table);
  return most.pinocchio < 1e-14 && most.kdl < 1e-14 && most.table < kTolerance;
}

BENCHMARK_TEMPLATE(floor_of_all, float);
BENCHMARK_TEMPLATE(floor_of_all, double);
BENCHMARK_TEMPLATE(look_up, float)->DenseRange(4, 7);
BENCHMARK_TEMPLATE(look_up, double)->Arg(6);
BENCHMARK(look_up_cold);
BENCHMARK(grid_look_up)->DenseRange(1, 4);
BENCHMARK_TEMPLATE(tick, float);
BENCHMARK_TEMPLATE(tick, double);
BENCHMARK_TEMPLATE(direct, float);
BENCHMARK_TEMPLATE(direct, double);
BENCHMARK(pinocchio_direct);
BENCHMARK(kdl_direct);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  if (!all_agree()) {
    std::fprintf(stderr, "bench_tick: they do not compute the same\n");
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
