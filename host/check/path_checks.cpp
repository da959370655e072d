#include "check/path_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "check/angles.hpp"
#include "check/arm.hpp"
#include "check/motion.hpp"
#include "check/times.hpp"
#include "effects/beyond_tables.hpp"
#include "linear_algebra/decompositions.hpp"

namespace flexcomp::check {
namespace {

Check said_of_path(Severity severity, const char* name, const recording::Recording& path,
                   Eigen::Index row, const std::string& what, const char* fix) {
  return {severity, "path", name, path.place(row) + ": " + what, fix};
}

/// The row in which a joint is farthest beyond its limits.
Checks check_angle_limits(const model::Robot& robot, const recording::Recording& path) {
  constexpr double kRounding = 1e-6;  // rad: the core compares in float
  Checks checks;
  for (Eigen::Index joint = 0; joint < joint_count(robot); ++joint) {
    const Joint<double>& limits = joint_of(robot, joint);
    Eigen::Index first = -1;
    Eigen::Index count = 0;
    double farthest = 0;
    for (Eigen::Index row = 0; row < path.size(); ++row) {
      const double angle = (*path.q_cmd)(row, joint);
      if (angle < limits.lower - kRounding || angle > limits.upper + kRounding) {
        first = count == 0 ? row : first;
        const double beyond = std::max(limits.lower - angle, angle - limits.upper);
        farthest = std::max(farthest, beyond);
        ++count;
      }
    }
    if (count > 0) {
      checks.push_back(said_of_path(
          Severity::error, "limits", path, first,
          fmt::format(
              "from here joint {} is beyond its limits of {:.4g} to {:.4g} rad in {} row{}, "
              "by up to {:.3g} rad",
              joint + 1, limits.lower, limits.upper, count, count > 1 ? "s" : "", farthest),
          "move the job (flexcomp place), turn the tool, or take the other posture"));
    }
  }
  return checks;
}

Checks check_speed_limits(const model::Robot& robot, const recording::Recording& path) {
  constexpr double kMargin = 1.02;  // times the limit, for a planner's rounding
  constexpr double kJump = 5;       // times the limit
  Checks checks;
  for (Eigen::Index joint = 0; joint < joint_count(robot); ++joint) {
    const double limit = robot.dynamics[static_cast<std::size_t>(joint)].velocity;
    Eigen::Index worst = -1;
    double most = kMargin * limit;
    for (Eigen::Index row = 1; limit > 0 && row < path.size(); ++row) {
      const double speed = std::abs((*path.q_cmd)(row, joint) - (*path.q_cmd)(row - 1, joint)) /
                           (path.time[row] - path.time[row - 1]);
      if (speed > most) {
        most = speed;
        worst = row;
      }
    }
    if (worst >= 0) {
      const bool jumps = most > kJump * limit;
      checks.push_back(said_of_path(
          Severity::error, jumps ? "path.jump" : "limits", path, worst,
          fmt::format("joint {} {} {:.3g} rad/s, {:.2g} times its limit of {:.3g}", joint + 1,
                      jumps ? "jumps: it would move at" : "moves at", most, most / limit, limit),
          jumps ? "check for a posture that flips, an angle that wraps round, or a missing row"
                : "go slower there, or move the job away from the singularity"));
    }
  }
  return checks;
}

/// Stretches of rows whose Jacobian is nearly singular.
Checks check_singularities(const model::Robot& robot, const recording::Recording& path) {
  // Least singular value, metres and radians alike. flexcomp place stays above 0.05.
  constexpr double kNear = 0.02;
  constexpr Eigen::Index kMostLookedAt = 4000;  // rows: time against a stretch between two of them
  if (joint_count(robot) < 6) {
    return {};
  }
  const Eigen::Index stride = std::max<Eigen::Index>(1, path.size() / kMostLookedAt);
  Eigen::Index stretches = 0;
  Eigen::Index first = -1;
  Eigen::Index last = -1;
  double least = kNear;
  bool was_near = false;
  for (Eigen::Index row = 0; row < path.size(); row += stride) {
    const Eigen::MatrixXd jacobian = jacobian_at(robot, path.q_cmd->row(row));
    const double value = Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues()[5];
    const bool is_near = value < kNear;
    if (is_near) {
      stretches += was_near ? 0 : 1;
      first = first < 0 ? row : first;
      last = row;
      least = std::min(least, value);
    }
    was_near = is_near;
  }
  if (stretches == 0) {
    return {};
  }
  return {said_of_path(Severity::warning, "path.singular", path, first,
                       fmt::format("{} stretch{} near a singularity, from here to row {} (least "
                                   "singular value {:.2g}): small corrections need large joint "
                                   "motions there",
                                   stretches, stretches > 1 ? "es" : "", last + 1, least),
                       "move or turn the job: flexcomp place keeps away from singularities")};
}

Check renamed_to_path(Check check) {
  check.about = "path";
  return check;
}

}  // namespace

Checks check_path(const model::Robot& robot, recording::Recording path) {
  Checks checks;
  if (!path.q_cmd || path.q_cmd->cols() != joint_count(robot)) {
    return {{Severity::error, "path", "path.angles",
             path.file + ": a path needs the columns q_cmd_1 to q_cmd_n, one a joint",
             "give the commanded joint angles in radians; flexcomp plan makes a path"}};
  }
  if (!path.q_cmd->allFinite()) {
    return {{Severity::error, "path", "path.angles",
             path.file + ": a commanded joint angle is missing", "give all of them in every row"}};
  }
  add(check_angles(robot, &path), &checks);
  add(check_times(&robot, &path), &checks);
  std::transform(checks.begin(), checks.end(), checks.begin(), renamed_to_path);
  add(check_angle_limits(robot, path), &checks);
  add(check_speed_limits(robot, path), &checks);
  add(check_singularities(robot, path), &checks);
  return checks;
}

Checks check_process(const model::Robot& robot, const recording::Recording& path,
                     const simulation::Process& process, const CorrectionLoop& loop) {
  const std::optional<RobotModel<double, 6>> core = model::six_axis_model(robot.elastic);
  if (!path.q_cmd || !path.wrench || path.wrench->isZero(0) || !path.wrench->allFinite() ||
      !path.q_cmd->allFinite() || !core) {
    return {};
  }
  const GainLimit limit = gain_limit(control::feedback_along(*core, path, process), loop);
  if (!limit.digs_in()) {
    return {};
  }
  const std::string deep = std::isfinite(limit.engagement)
                               ? fmt::format("would become {:.2g} times as deep", limit.engagement)
                               : "would dig in by itself";
  return {
      {Severity::error, "path", "process.unstable",
       fmt::format("{}: with this force and a cut {:g} mm deep the tool {}, with any gain that "
                   "is stable",
                   path.file, 1e3 * process.depth_of_cut, deep),
       "give the depth of your cut (--depth-of-cut) and the side of the contour that its "
       "material is on (--material); else take less force, or a stiffer place (flexcomp place)"}};
}

Checks check_table(const model::Robot& robot, const std::string& file, const Table& table) {
  if (table.model_hash() != model_hash(model::six_axis_model(robot))) {
    return {{Severity::error, "table", "table.other",
             file + ": the table is of another robot, tool or payload than the model",
             "make the table from this model: flexcomp table"}};
  }
  Checks checks;
  const std::string lacking = effects::warning_beyond_tables(robot);
  if (!lacking.empty()) {
    checks.push_back({Severity::warning, "table", "table.effects", lacking,
                      "correct programs with flexcomp compensate, or leave these effects to what a "
                      "correction in real time cannot know"});
  }
  const auto largest = static_cast<double>(table.header().largest_gain);
  if (largest > 0 && largest <= 1.01 * GainLimit::kNone) {
    checks.push_back(
        {Severity::error, "table", "process.unstable",
         file + ": no gain is safe with the process that the table was made for",
         "make the table with the depth of your cut (flexcomp table --depth-of-cut) and its side "
         "(--material), or for less force"});
  }
  return checks;
}

Checks check_coverage(const model::Robot& robot, const Table& table,
                      const recording::Recording& path) {
  constexpr double kRounding = 1e-3;  // rad: a path may be sampled anew between the table's points
  Checks checks;
  if (!path.q_cmd || !path.q_cmd->allFinite() || joint_count(robot) != 6) {
    return checks;
  }
  TableCursor cursor;
  Eigen::Index outside = 0;
  Eigen::Index first = -1;
  double farthest = 0;
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    const JointVector<double, 6> q = path.q_cmd->row(row).transpose();
    double off = look_up<double, 6>(table, q, &cursor).outside;
    if (off > kRounding) {
      locate<double, 6>(table, q, &cursor);
      off = look_up<double, 6>(table, q, &cursor).outside;
    }
    if (off > kRounding) {
      first = outside == 0 ? row : first;
      farthest = std::max(farthest, off);
      ++outside;
    }
  }
  if (outside > 0) {
    checks.push_back(
        {Severity::error, "table", "table.coverage",
         fmt::format("{}: from here {} of {} rows lie outside the table, by up to {:.3g} "
                     "rad",
                     path.place(first), outside, path.size(), farthest),
         "make the table from this path: flexcomp table --path"});
  }
  if (!path.wrench) {
    return checks;
  }
  const auto most_of = [](const auto& columns) {
    return columns.rowwise().norm().template maxCoeff<Eigen::PropagateNumbers>();
  };
  const double force = most_of(path.wrench->leftCols<3>());
  const double moment = most_of(path.wrench->rightCols<3>());
  const TableHeader& header = table.header();
  constexpr double kShaved = 1.000001;  // by rounding to float in the header
  if (force > kShaved * header.force_bound || moment > kShaved * header.moment_bound) {
    checks.push_back(
        {Severity::error, "table", "table.coverage",
         fmt::format("{}: loads up to {:.4g} N and {:.4g} N·m, but the table's "
                     "certificate holds up to {:.4g} N and {:.4g} N·m",
                     path.file, force, moment, header.force_bound, header.moment_bound),
         "make the table for the largest wrench that will act"});
  }
  return checks;
}

}  // namespace flexcomp::check
