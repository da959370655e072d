/// Cost of a table: time to build it and to check it, and its size for a certified error, beside
/// a plain uniform grid of compliances with the same error. The argument of a benchmark is the
/// negative decimal exponent of the tolerance (m, rad).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "milled_circle.hpp"
#include "plain_grid.hpp"

using namespace flexcomp;
using namespace flexcomp::bench;

namespace {

const MilledCircle& circle() {
  static const MilledCircle made = milled_circle();
  return made;
}

double tolerance_of(const benchmark::State& state) {
  return std::pow(10.0, -static_cast<double>(state.range(0)));
}

void describe_table(benchmark::State& state, const std::vector<std::uint32_t>& words) {
  state.counters["bytes"] = static_cast<double>(4 * words.size());
  state.counters["nodes"] = opened(words).header().node_count;
  state.counters["certified"] = static_cast<double>(opened(words).header().position_error);
}

void time_each(benchmark::State& state, double things) {
  state.counters["s"] = benchmark::Counter(
      things, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build_path(benchmark::State& state) {
  std::vector<std::uint32_t> words;
  for (auto _ : state) {
    words = path_table(circle(), tolerance_of(state));
  }
  describe_table(state, words);
  time_each(state, 1);
}

/// The middle joints' ranges along the circle.
void build_grid(benchmark::State& state) {
  GridRange<double> ranges[4];
  joint_ranges(circle(), &ranges);
  std::vector<std::uint32_t> words;
  for (auto _ : state) {
    words = grid_table(circle().robot, ranges, tolerance_of(state));
  }
  describe_table(state, words);
  time_each(state, 1);
}

/// Against the model, at one place after the other: what `flexcomp table verify` does.
void verify(benchmark::State& state) {
  const auto words = path_table(circle(), tolerance_of(state));
  const Table table = opened(words);
  TableCursor cursor;
  for (auto _ : state) {
    for (const JointVector<double, 6>& q : circle().setpoints.q) {
      benchmark::DoNotOptimize(table_error_at<double, 6>(circle().robot, table, q, &cursor));
    }
  }
  time_each(state, static_cast<double>(circle().setpoints.size()));
}

/// Checks that a node makes before it uses a table.
void open_table(benchmark::State& state) {
  const auto words = path_table(circle(), tolerance_of(state));
  for (auto _ : state) {
    benchmark::DoNotOptimize(opened(words));
  }
  time_each(state, 1);
}

/// Not a matter of time: the size of the plain grid that errs no more than the path table may.
void plain_grid(benchmark::State& state) {
  const auto words = path_table(circle(), tolerance_of(state));
  const auto certified = static_cast<double>(opened(words).header().position_error);
  PlainGrid grid{};
  for (auto _ : state) {
    grid = coarsest_plain_grid(circle(), certified);
  }
  state.counters["bytes"] = grid.bytes;
  state.counters["step"] = grid.step;
}

BENCHMARK(build_path)->DenseRange(4, 7)->Unit(benchmark::kMillisecond);
BENCHMARK(build_grid)->DenseRange(3, 5)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(verify)->Arg(6)->Unit(benchmark::kMillisecond);
BENCHMARK(open_table)->Arg(6)->Unit(benchmark::kMicrosecond);
BENCHMARK(plain_grid)->DenseRange(4, 7)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
