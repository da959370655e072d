#include "planning/program_plan.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "error.hpp"

namespace flexcomp::planning {
namespace {

/// The cutting wrench at a point, in the work frame.
Wrench<double> wrench_at(const PathPoint& point, const Wrench<double>& cutting) {
  constexpr double kAlongTheAxis = 1e-3;  // less of the feed's direction is across the tool's axis
  const Vector3<double> up = -point.pose.rotation.col(2);
  const Vector3<double> feed = point.feed_direction - up.dot(point.feed_direction) * up;
  Matrix3<double> frame = Matrix3<double>::Zero();
  frame.col(2) = up;
  if (feed.norm() >= kAlongTheAxis) {
    frame.col(0) = feed.normalized();
    frame.col(1) = up.cross(frame.col(0));
  }
  Wrench<double> wrench;
  wrench << frame * cutting.head<3>(), frame * cutting.tail<3>();
  return wrench;
}

}  // namespace

PlannedProgram plan_program(const RobotModel<double, 6>& model, const programs::Program& program,
                            const ProgramPlan& plan,
                            const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::vector<PathPoint> points = sample(program, plan.sampling);
  if (points.size() < 2) {
    throw InputError(fmt::format("{}: a program needs two motions or more", program.file));
  }
  PlannedProgram planned;
  planned.path =
      follow(model, program, points, plan.frame ? plan.frame : program.frame, plan.near, progress);
  const auto rows = static_cast<Eigen::Index>(points.size());
  recording::Recording& recording = planned.recording;
  recording.file = program.file;
  recording.time = times_along(program, points, planned.path.q, plan.limits);
  recording.q_cmd = planned.path.q;
  recording.wrench = recording::Samples::Zero(rows, 6);
  recording.program_line = recording::Samples(rows, 1);
  const Matrix3<double>& turn = planned.path.frame.rotation;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const PathPoint& point = points[static_cast<std::size_t>(row)];
    const programs::Motion& motion = program.motions[point.motion];
    (*recording.program_line)(row, 0) = static_cast<double>(motion.line);
    if (motion.is_cutting) {
      const Wrench<double> wrench = wrench_at(point, plan.cutting);
      recording.wrench->row(row) << (turn * wrench.head<3>()).transpose(),
          (turn * wrench.tail<3>()).transpose();
    }
  }
  return planned;
}

}  // namespace flexcomp::planning
