#include "planning/circle.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "error.hpp"
#include "planning/inverse_kinematics.hpp"

namespace flexcomp::planning {
namespace {

/// Joints that turn by more than this (rad) from one point to the next have changed their branch.
constexpr double kLargestStep = 0.35;

/// Directions at one point of the circle: out of it, along the feed, and the plane's normal.
Matrix3<double> path_frame(const CirclePlan& plan, double angle) {
  const Vector3<double> out =
      std::cos(angle) * plan.first_axis + std::sin(angle) * plan.second_axis;
  const Vector3<double> normal = plan.first_axis.cross(plan.second_axis);
  Matrix3<double> frame;
  frame << out, normal.cross(out) * (plan.clockwise ? -1 : 1), normal;
  return frame;
}

/// Tool orientation with z along the tool axis and x as near as can be to the base's x (or z).
Matrix3<double> tool_orientation(const Vector3<double>& tool_axis) {
  const Vector3<double> aim =
      std::abs(tool_axis.x()) < 0.9 ? Vector3<double>::UnitX() : Vector3<double>::UnitZ();
  const Vector3<double> y = tool_axis.cross(aim).normalized();
  Matrix3<double> orientation;
  orientation << y.cross(tool_axis), y, tool_axis;
  return orientation;
}

class CirclePlanner {
 public:
  CirclePlanner(const RobotModel<double, 6>& model, const CirclePlan& plan)
      : model_(model), plan_(plan), orientation_(tool_orientation(plan.tool_axis)) {}

  /// Follows the circle from one of the postures that reach its first point; the first that gets
  /// all the way round is taken.
  recording::Samples plan(const std::function<void(int)>& progress) {
    const std::vector<Angles> starts = solve_all(model_, target(0));
    if (starts.empty()) {
      throw InputError(
          "the circle cannot be reached: no posture within the joint limits reaches its "
          "first point with this tool axis");
    }
    recording::Samples path(plan_.points + 1, 6);
    int farthest = 0;
    for (const Angles& start : starts) {
      const int reached = follow(start, progress, &path);
      if (reached > plan_.points) {
        return path;
      }
      farthest = std::max(farthest, reached);
    }
    throw InputError(fmt::format(
        "the circle cannot be reached all the way round: no posture gets past {:.0f}° within the "
        "joint limits and without a jump",
        360.0 * farthest / plan_.points));
  }

  double angle(int point) const { return (plan_.clockwise ? -2 : 2) * M_PI * point / plan_.points; }

 private:
  Pose<double> target(int point) const {
    return {orientation_, plan_.center + plan_.radius * path_frame(plan_, angle(point)).col(0)};
  }

  /// Number of points reached.
  int follow(const Angles& start, const std::function<void(int)>& progress,
             recording::Samples* path) const {
    Angles q = start;
    path->row(0) = q.transpose();
    for (int point = 1; point <= plan_.points; ++point) {
      // The circle closes: its last point is its first, to the last bit.
      const std::optional<Angles> next = point == plan_.points
                                             ? std::optional<Angles>(start)
                                             : solve_near(model_, target(point), q);
      if (!next || (*next - q).cwiseAbs().maxCoeff() > kLargestStep) {
        return point;
      }
      q = *next;
      path->row(point) = q.transpose();
      progress(point);
    }
    return plan_.points + 1;
  }

  const RobotModel<double, 6>& model_;
  const CirclePlan& plan_;
  Matrix3<double> orientation_;
};

}  // namespace

recording::Recording plan_circle(const RobotModel<double, 6>& model, const CirclePlan& plan,
                                 const std::function<void(int)>& progress) {
  CirclePlanner planner(model, plan);
  recording::Recording recording;
  recording.q_cmd = planner.plan(progress);
  recording.time.resize(plan.points + 1);
  recording.wrench = recording::Samples(plan.points + 1, 6);
  const double step = 2 * M_PI * plan.radius / plan.feed / plan.points;
  for (int point = 0; point <= plan.points; ++point) {
    recording.time[point] = step * point;
    const Matrix3<double> frame = path_frame(plan, planner.angle(point % plan.points));
    recording.wrench->row(point) << (frame * plan.force).transpose(),
        (frame * plan.moment).transpose();
  }
  return recording;
}

}  // namespace flexcomp::planning
