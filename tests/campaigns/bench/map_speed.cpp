/// The study's map of a robot, by flexcomp and with Pinocchio, in path points per second. What both
/// do is the same: circles of 72 points about the nodes of a grid, the arm's closed-form inverse
/// kinematics, the deflection at each point, the least-squares circularity of what is milled. The
/// one with Pinocchio is given flexcomp's inverse kinematics and circularity.
#include <benchmark/benchmark.h>
#include <sched.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <string>
#include <vector>

#include "geometry/nearly_round.hpp"
#include "model/robot.hpp"
#include "pinocchio_arm.hpp"
#include "study/circularity_map.hpp"
#include "study/presets.hpp"

using namespace flexcomp;
using study::Planar;

namespace {

constexpr double kStudyStep = 0.05;  // m

const RobotModel<double, 6>& robot() {
  static const RobotModel<double, 6> loaded =
      model::six_axis_model(model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/kr270/robot.yaml"));
  return loaded;
}

/// The default of the study: preset strict, without joint limits.
study::MilledCircle circle() {
  study::MilledCircle strict = study::preset("strict").circle;
  strict.has_limits = false;
  return strict;
}

study::CircularityMap map_of(const study::CircleStudy& study, double step) {
  return study::map_circularity(study, step, [](std::size_t, std::size_t) {});
}

double points_in(const study::CircularityMap& map) {
  return static_cast<double>(study::summarize(map).reached *
                             static_cast<std::size_t>(circle().points));
}

class PinocchioMap {
 public:
  explicit PinocchioMap(const study::PlanarArm& arm) : arm_(arm), chain_(robot(), 5) {}

  /// m; NaN where out of reach.
  double circularity(Planar center) {
    const study::MilledCircle made = circle();
    Eigen::ArrayXd x(made.points);
    Eigen::ArrayXd z(made.points);
    for (int i = 0; i < made.points; ++i) {
      const Planar radial = std::polar(1.0, 2 * M_PI * i / made.points);
      const Planar at = center + made.radius * radial;
      const Planar reach = at - arm_.shoulder;
      const double square = std::norm(reach);
      const double along =
          (std::norm(arm_.upper_arm) - std::norm(arm_.forearm) + square) / (2 * square);
      const double height = std::norm(arm_.upper_arm) / square - along * along;
      if (!(height >= 0)) {
        return NAN;
      }
      const Planar elbow = arm_.shoulder + reach * Planar(along, std::sqrt(height));
      const JointVector<double, 6> q = arm_.angles(elbow, at);
      const Planar force = Planar(made.force[0], made.force[1]) * radial;
      const Planar moment = Planar(made.moment[0], made.moment[1]) * radial;
      Wrench<double> wrench;
      wrench << force.real(), -made.force[2], force.imag(), moment.real(), -made.moment[2],
          moment.imag();
      const Twist<double> moved = chain_.deflection(q, wrench);
      x[i] = made.radius * radial.real() + moved[0];
      z[i] = made.radius * radial.imag() + moved[2];
    }
    return geometry::nearly_round_circularity(x, z);
  }

 private:
  study::PlanarArm arm_;
  bench::PinocchioArm chain_;
};

/// Runs on one core, or on all that this process may use.
class Cores {
 public:
  explicit Cores(bool one) {
    sched_getaffinity(0, sizeof before_, &before_);
    if (one) {
      cpu_set_t single;
      CPU_ZERO(&single);
      CPU_SET(static_cast<unsigned>(sched_getcpu()), &single);
      sched_setaffinity(0, sizeof single, &single);
    }
  }
  Cores(const Cores&) = delete;
  ~Cores() { sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

void count(benchmark::State& state, double points) {
  state.counters["points"] =
      benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["total"] = points;
}

void flexcomp_map(benchmark::State& state) {
  const Cores cores(state.range(0) == 1);
  const study::CircleStudy study(robot(), circle());
  const double step = 1e-3 * static_cast<double>(state.range(1));
  const double points = points_in(map_of(study, step));
  for (auto _ : state) {
    benchmark::DoNotOptimize(map_of(study, step).circularity.data());
  }
  count(state, points);
}

void pinocchio_map(benchmark::State& state) {
  const study::CircleStudy study(robot(), circle());
  const study::CircularityMap map = map_of(study, kStudyStep);
  PinocchioMap peer(study.arm());
  double farthest = 0;
  for (auto _ : state) {
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const double value = peer.circularity({map.x(column), map.z(row)});
        if (std::isnan(value) != std::isnan(map.at(column, row))) {
          state.SkipWithError("the maps do not reach as far");
          return;
        }
        farthest = std::fmax(farthest, std::abs(value - map.at(column, row)));
      }
    }
  }
  if (farthest > 1e-12) {
    state.SkipWithError("the maps do not agree to 1e-12 m");
  }
  count(state, points_in(map));
}

const std::vector<std::int64_t> kSteps = {200, 100, 50, 25};  // mm

BENCHMARK(flexcomp_map)
    ->ArgNames({"cores", "step"})
    ->ArgsProduct({{1}, kSteps})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(flexcomp_map)
    ->ArgNames({"cores", "step"})  // 0 cores: all
    ->ArgsProduct({{0}, kSteps})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pinocchio_map)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
