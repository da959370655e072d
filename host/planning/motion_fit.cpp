#include "planning/motion_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planning/program_path.hpp"

namespace flexcomp::planning {
namespace {

using programs::Motion;
using programs::MotionKind;

class Fit {
 public:
  Fit(const Motion& motion, const std::vector<Pose<double>>& poses, double tolerance)
      : motion_(motion), poses_(poses), tolerance_(tolerance) {}

  void pass(std::size_t first, std::size_t last) {
    Motion one = to(last);
    std::size_t worst = first;
    if (motion_.kind == MotionKind::circular && last > first + 1) {
      const std::optional<programs::Arc> arc = programs::arc_through(
          poses_[first].position, poses_[(first + last) / 2].position, poses_[last].position);
      one.kind = arc ? MotionKind::circular : MotionKind::linear;
      one.arc = arc.value_or(programs::Arc{});
      // Controllers tell no circle by three points that is nearly a whole one.
      constexpr double kMostTurn = 6.0;  // rad
      if (!arc || arc->angle > kMostTurn || off(one, first, last, &worst) > tolerance_) {
        worst = (first + last) / 2;
      } else {
        worst = first;
      }
    } else if (last > first + 1) {
      one.kind = MotionKind::linear;
      worst = off(one, first, last, &worst) > tolerance_ ? worst : first;
    } else {
      one.kind = MotionKind::linear;
    }
    if (worst == first) {
      found_.push_back(one);
      return;
    }
    pass(first, worst);
    pass(worst, last);
  }

  std::vector<Motion> take() { return std::move(found_); }

 private:
  Motion to(std::size_t last) const {
    Motion motion = motion_;
    motion.end = poses_[last];
    return motion;
  }

  /// How far the poses between are off a motion, and which is farthest.
  double off(const Motion& one, std::size_t first, std::size_t last, std::size_t* worst) const {
    double largest = 0;
    *worst = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = share_of(one, first, last, i);
      const Pose<double> passed = programs::pose_at(poses_[first], one, share);
      const double distance_here = distance(passed, poses_[i]);
      if (distance_here > largest) {
        largest = distance_here;
        *worst = i;
      }
    }
    return largest;
  }

  double share_of(const Motion& one, std::size_t first, std::size_t last, std::size_t i) const {
    const Vector3<double>& from = poses_[first].position;
    const Vector3<double>& at = poses_[i].position;
    if (one.kind == MotionKind::circular) {
      const Vector3<double> a = from - one.arc.center;
      const Vector3<double> b = at - one.arc.center;
      double angle = std::atan2(one.arc.normal.dot(a.cross(b)), a.dot(b));
      angle += angle < 0 ? 2 * M_PI : 0;
      return std::clamp(angle / one.arc.angle, 0.0, 1.0);
    }
    const Vector3<double> along = poses_[last].position - from;
    const double length = along.squaredNorm();
    if (length < 1e-18) {  // it only turns
      return static_cast<double>(i - first) / static_cast<double>(last - first);
    }
    return std::clamp(along.dot(at - from) / length, 0.0, 1.0);
  }

  const Motion& motion_;
  const std::vector<Pose<double>>& poses_;
  double tolerance_;
  std::vector<Motion> found_;
};

}  // namespace

std::vector<Motion> fit_motion(const Motion& motion, const std::vector<Pose<double>>& poses,
                               std::size_t first, std::size_t last, double tolerance) {
  if (motion.kind == MotionKind::rapid || first == last) {
    Motion one = motion;
    one.kind = motion.kind == MotionKind::rapid ? MotionKind::rapid : MotionKind::linear;
    one.end = poses[last];
    return {one};
  }
  Fit fit(motion, poses, tolerance);
  fit.pass(first, last);
  return fit.take();
}

}  // namespace flexcomp::planning
