#include "effects/beyond_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "effects/learned.hpp"

namespace flexcomp::effects {
namespace {

/// A program in which every joint swings about the middle of its range, each at its own pace, under
/// a wrench that turns, while the robot warms.
Scene swinging(const model::Robot& robot) {
  constexpr Eigen::Index kRows = 200;
  constexpr double kStep = 0.01;  // s
  constexpr double kSwing = 0.3;  // rad
  recording::Recording program;
  program.time = kStep * Eigen::VectorXd::LinSpaced(kRows, 0, kRows - 1);
  program.q_cmd = recording::Samples::Zero(kRows, robot.joints());
  program.wrench = recording::Samples::Zero(kRows, 6);
  program.position = recording::Samples::Zero(kRows, 3);
  program.temperature = recording::Samples::Zero(kRows, 1);
  for (Eigen::Index row = 0; row < kRows; ++row) {
    const double turn = 2 * M_PI * static_cast<double>(row) / kRows;
    for (Eigen::Index joint = 0; joint < robot.joints(); ++joint) {
      const auto& limits = robot.elastic.joint(joint);
      const double range = std::min(limits.upper - limits.lower, 2 * M_PI);
      const double middle =
          std::isfinite(limits.upper + limits.lower) ? 0.5 * (limits.upper + limits.lower) : 0;
      (*program.q_cmd)(row, joint) =
          middle + std::min(kSwing, 0.2 * range) * std::sin(turn * static_cast<double>(1 + joint));
    }
    program.wrench->row(row) << 500 * std::cos(turn), 500 * std::sin(turn), 300, 20, 10, 30;
    (*program.temperature)(row, 0) = 20 + 0.1 * static_cast<double>(row);
  }
  simulation::Preparation preparation;
  return simulation::prepare(program, kRows, &preparation);
}

Eigen::MatrixXd positions(const model::Robot& robot, const Scene& scene) {
  const Machine machine = machine_of(robot, {scene});
  return with_terms(machine.terms, scene, simulate(machine, scene))
      .channel[simulation::tcp_position];
}

}  // namespace

std::vector<std::string> beyond_tables(const model::Robot& robot) {
  constexpr double kNoticeable = 1e-7;  // m: a tenth of what tables are certified to
  std::vector<std::string> names;
  if (robot.effects.empty()) {
    return names;
  }
  const Scene scene = swinging(robot);
  model::Robot with = robot;
  with.effects.clear();
  const Eigen::MatrixXd plain = positions(with, scene);
  for (const model::LearnedEffect& each : robot.effects) {
    with.effects = {each};
    const bool moves = law_of(robot, each)->traits.can_be_undone &&
                       (positions(with, scene) - plain).cwiseAbs().maxCoeff() > kNoticeable;
    if (moves && std::find(names.begin(), names.end(), each.effect) == names.end()) {
      names.push_back(each.effect);
    }
  }
  return names;
}

std::string warning_beyond_tables(const model::Robot& robot) {
  const std::vector<std::string> names = beyond_tables(robot);
  return names.empty()
             ? ""
             : fmt::format(
                   "{}: effects: a table, and the correction in real time with it, lacks {}: "
                   "it knows the model's other keys only; flexcomp compensate corrects "
                   "programs for them",
                   robot.yaml.string(), fmt::join(names, ", "));
}

}  // namespace flexcomp::effects
