#include "planning/program_correction.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/chain.hpp"
#include "planning/motion_fit.hpp"

namespace flexcomp::planning {
namespace {

using Poses = std::vector<Pose<double>>;

Poses poses_of(const RobotModel<double, 6>& model, const recording::Samples& q) {
  Poses poses;
  poses.reserve(static_cast<std::size_t>(q.rows()));
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    poses.push_back(forward_kinematics<double, 6>(model, q.row(row).transpose()).tcp);
  }
  return poses;
}

/// Rows of a motion: [first, last].
struct Rows {
  std::size_t first = 1;
  std::size_t last = 0;

  bool is_empty() const { return first > last; }
};

/// Which rows belong to which motion. Throws InputError for a line that is none of the program's,
/// in its order.
std::vector<Rows> rows_of(const programs::Program& program, const recording::Recording& path) {
  const recording::Samples& lines = recording::require(path, path.program_line, "line");
  std::vector<Rows> rows(program.motions.size());
  std::size_t motion = 0;
  for (Eigen::Index row = 0; row < lines.rows(); ++row) {
    const auto line = static_cast<double>(lines(row, 0));
    while (motion < rows.size() && static_cast<double>(program.motions[motion].line) != line) {
      ++motion;
    }
    if (motion == rows.size()) {
      throw InputError(fmt::format("{}: column 'line': no motion of {} stands in line {:g} here",
                                   path.place(row), program.file, line));
    }
    Rows& of = rows[motion];
    of.first = of.is_empty() ? static_cast<std::size_t>(row) : of.first;
    of.last = static_cast<std::size_t>(row);
  }
  return rows;
}

/// The work frame that a path was placed in: by least squares over the motions' ends and where the
/// tool points there, of which the path may have turned the tool about its own axis.
Pose<double> frame_between(const programs::Program& program, const std::vector<Rows>& rows,
                           const Poses& poses) {
  std::vector<Vector3<double>> from;
  std::vector<Vector3<double>> to;
  constexpr double kAlong = 0.1;  // m, along the tool's axis
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].is_empty()) {
      const Pose<double>& wanted = program.motions[i].end;
      const Pose<double>& found = poses[rows[i].last];
      from.push_back(wanted.position);
      to.push_back(found.position);
      from.emplace_back(wanted.position + kAlong * wanted.rotation.col(2));
      to.emplace_back(found.position + kAlong * found.rotation.col(2));
    }
  }
  const auto count = static_cast<Eigen::Index>(from.size());
  const Eigen::Matrix4d fit =
      Eigen::umeyama(Eigen::Map<const Eigen::Matrix3Xd>(from.front().data(), 3, count),
                     Eigen::Map<const Eigen::Matrix3Xd>(to.front().data(), 3, count), false);
  return {fit.topLeftCorner<3, 3>(), fit.topRightCorner<3, 1>()};
}

void refuse_another_program(const programs::Program& program, const std::vector<Rows>& rows,
                            const Poses& poses, const Pose<double>& frame,
                            const recording::Recording& path) {
  constexpr double kLargest = 2e-6;  // m: more is no rounding
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].is_empty()) {
      continue;
    }
    const Pose<double> wanted = frame * program.motions[i].end;
    const double off = (wanted.position - poses[rows[i].last].position).norm();
    if (!(off <= kLargest)) {
      throw InputError(fmt::format("{}: is not the path of this program: {:.4g} mm off {}:{}",
                                   path.place(static_cast<Eigen::Index>(rows[i].last)), 1e3 * off,
                                   program.file, program.motions[i].line));
    }
  }
}

/// The largest distance between a path and the same path corrected. Throws InputError where it is
/// more than any robot that mills gives way.
double largest_correction(const Poses& planned, const Poses& corrected,
                          const recording::Recording& path,
                          const recording::Recording& corrected_path) {
  constexpr double kMost = 0.03;  // m
  double largest = 0;
  for (std::size_t row = 0; row < planned.size(); ++row) {
    const double correction = (corrected[row].position - planned[row].position).norm();
    if (!(correction <= kMost)) {
      throw InputError(fmt::format(
          "{}: lies {:.4g} mm off {}, which is no correction: expected that path corrected, not "
          "that of another job or placement",
          corrected_path.place(static_cast<Eigen::Index>(row)), 1e3 * correction, path.file));
    }
    largest = std::max(largest, correction);
  }
  return largest;
}

}  // namespace

programs::CorrectedProgram correct_program(const RobotModel<double, 6>& model,
                                           const programs::Program& program,
                                           const recording::Recording& path,
                                           const recording::Recording& corrected,
                                           double tolerance) {
  const recording::Samples& q = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
  const recording::Samples& moved =
      recording::require(corrected, corrected.q_cmd, "q_cmd_1..q_cmd_6");
  if (q.rows() != moved.rows()) {
    throw InputError(fmt::format("{} has {} rows, {} has {}: it is not this path corrected",
                                 path.file, q.rows(), corrected.file, moved.rows()));
  }
  const std::vector<Rows> rows = rows_of(program, path);
  const Poses poses = poses_of(model, q);
  programs::CorrectedProgram result;
  result.source = program;
  result.frame = frame_between(program, rows, poses);
  refuse_another_program(program, rows, poses, result.frame, path);
  const Pose<double> back = inverse(result.frame);
  Poses ways = poses_of(model, moved);
  result.largest_correction = largest_correction(poses, ways, path, corrected);
  for (Pose<double>& pose : ways) {
    pose = back * pose;
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t end = rows[i].is_empty() ? at : rows[i].last;
    result.in_place.push_back(fit_motion(program.motions[i], ways, at, end, tolerance));
    at = end;
  }
  return result;
}

}  // namespace flexcomp::planning
