#include "milled_circle.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "model/robot.hpp"
#include "planning/circle.hpp"

namespace flexcomp::bench {
namespace {

constexpr double kRadius = 0.1;   // m
constexpr double kFeed = 0.05;    // m/s
constexpr double kPeriod = 4e-3;  // s

void require(Result result, const char* what) {
  if (result != Result::ok) {
    std::fprintf(stderr, "%s: %s\n", what, describe(result));
    std::exit(3);
  }
}

recording::Recording planned(const RobotModel<double, 6>& robot) {
  planning::CirclePlan plan;
  plan.center = {1.6, 0, 1.2};
  plan.first_axis = Vector3<double>::UnitX();
  plan.second_axis = Vector3<double>::UnitZ();
  plan.radius = kRadius;
  plan.points = 720;
  plan.feed = kFeed;
  plan.tool_axis = Vector3<double>::UnitY();
  plan.force = {440, 1370, 635};
  plan.moment = {0, 3, 10.5};
  return planning::plan_circle(robot, plan, [](int) {});
}

TableRequirements<double> requirements(double tolerance) {
  return {kForceBound, kMomentBound, tolerance, tolerance, 0};
}

/// Calls a builder with a buffer that grows until the table fits.
template <typename Build>
std::vector<std::uint32_t> built(const Build& build) {
  for (std::size_t words = std::size_t{1} << 18;; words *= 4) {
    std::vector<std::uint32_t> buffer(words);
    std::size_t size = 0;
    const Result result = build(buffer.data(), 4 * words, &size);
    if (result != Result::buffer_too_small) {
      require(result, "no table");
      buffer.resize(size / 4);
      return buffer;
    }
  }
}

}  // namespace

MilledCircle milled_circle() {
  MilledCircle circle;
  circle.robot =
      model::six_axis_model(model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/kr270/robot.yaml"));
  const recording::Recording path = planned(circle.robot);
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    circle.program.emplace_back(path.q_cmd->row(row).transpose());
  }
  Eigen::Index row = 0;
  for (double t = 0; t < path.time[path.size() - 1]; t += kPeriod) {
    while (path.time[row + 1] <= t) {
      ++row;
    }
    const double share = (t - path.time[row]) / (path.time[row + 1] - path.time[row]);
    const auto between = [&](const recording::Samples& samples) {
      return JointVector<double, 6>((1 - share) * samples.row(row).transpose() +
                                    share * samples.row(row + 1).transpose());
    };
    circle.setpoints.q.push_back(between(*path.q_cmd));
    circle.setpoints.wrench.push_back(between(*path.wrench));
  }
  return circle;
}

Setpoints<float> in_single_precision(const Setpoints<double>& setpoints) {
  Setpoints<float> single;
  for (std::size_t i = 0; i < setpoints.size(); ++i) {
    single.q.emplace_back(setpoints.q[i].cast<float>());
    single.wrench.emplace_back(setpoints.wrench[i].cast<float>());
  }
  return single;
}

std::vector<std::uint32_t> path_table(const MilledCircle& circle, double tolerance) {
  return built([&](void* buffer, std::size_t capacity, std::size_t* size) {
    return build_path_table<double, 6>(circle.robot, circle.program.data(), circle.program.size(),
                                       requirements(tolerance), buffer, capacity, size);
  });
}

std::vector<std::uint32_t> grid_table(const RobotModel<double, 6>& robot,
                                      const GridRange<double> (&ranges)[4], double tolerance) {
  return built([&](void* buffer, std::size_t capacity, std::size_t* size) {
    return build_grid_table<double, 6>(robot, ranges, requirements(tolerance), buffer, capacity,
                                       size);
  });
}

Table opened(const std::vector<std::uint32_t>& words) {
  Table table;
  require(Table::open(words.data(), 4 * words.size(), &table), "not a table");
  return table;
}

}  // namespace flexcomp::bench
