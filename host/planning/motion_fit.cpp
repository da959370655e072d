#include "planning/motion_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

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
    const bool is_arc = motion_.kind == MotionKind::circular && last > first + 1;
    const std::optional<Motion> one = is_arc ? arc(first, last) : line(first, last);
    const std::size_t middle = is_arc ? (first + last) / 2 : worst_;
    if (one) {
      found_.push_back(*one);
      return;
    }
    pass(first, middle);
    pass(middle, last);
  }

  std::vector<Motion> take() { return std::move(found_); }

 private:
  /// The arc through three of the poses, if it passes all; nothing else.
  std::optional<Motion> arc(std::size_t first, std::size_t last) {
    // Controllers tell no circle by three points that is nearly a whole one.
    constexpr double kMostTurn = 6.0;  // rad
    const std::optional<programs::Arc> through = programs::arc_through(
        poses_[first].position, poses_[(first + last) / 2].position, poses_[last].position);
    if (!through || through->angle > kMostTurn) {
      return std::nullopt;
    }
    Motion one = motion_;
    one.end = poses_[last];
    one.arc = *through;
    const bool fits = off(one, first, last) <= tolerance_ && bulges_as_it_should(one, first, last);
    return fits ? std::optional<Motion>(one) : std::nullopt;
  }

  /// Is an arc between neighbouring poses as high above their chord as the program's own arc there?
  /// Three poses are on a circle, always, which may lead anywhere between them.
  bool bulges_as_it_should(const Motion& one, std::size_t first, std::size_t last) const {
    if (one.arc.normal.dot(motion_.arc.normal) <= 0) {
      return false;
    }
    const double own = radius_at(motion_.end.position, motion_.arc);
    const double radius = radius_at(poses_[first].position, one.arc);
    double before = 0;
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double share = i == last ? 1 : share_of(one, first, last, i);
      const double half = (share - before) * one.arc.angle / 2;
      const double half_chord = radius * std::sin(half);
      const double height = radius * (1 - std::cos(half));
      if (!(half < M_PI / 2) || !(half_chord < own) ||
          std::abs(height - (own - std::sqrt(own * own - half_chord * half_chord))) > tolerance_) {
        return false;
      }
      before = share;
    }
    return true;
  }

  static double radius_at(const Vector3<double>& place, const programs::Arc& arc) {
    const Vector3<double> off = place - arc.center;
    return (off - arc.normal.dot(off) * arc.normal).norm();
  }

  std::optional<Motion> line(std::size_t first, std::size_t last) {
    Motion one = motion_;
    one.kind = motion_.kind == MotionKind::rapid ? MotionKind::rapid : MotionKind::linear;
    one.end = poses_[last];
    return off(one, first, last) <= tolerance_ ? std::optional<Motion>(one) : std::nullopt;
  }

  /// How far the poses between are off a motion; notes which is farthest.
  double off(const Motion& one, std::size_t first, std::size_t last) {
    double largest = 0;
    worst_ = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = share_of(one, first, last, i);
      const Pose<double> passed = programs::pose_at(poses_[first], one, share);
      const double distance_here = distance(passed, poses_[i]);
      if (distance_here > largest) {
        largest = distance_here;
        worst_ = i;
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
  std::size_t worst_ = 0;
  std::vector<Motion> found_;
};

}  // namespace

std::vector<Motion> fit_motion(const Motion& motion, const std::vector<Pose<double>>& poses,
                               std::size_t first, std::size_t last, double tolerance) {
  if (first == last) {
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
