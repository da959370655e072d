#include "planning/program_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flexcomp::planning {
namespace {

using programs::Motion;
using programs::MotionKind;

constexpr double kStands = 1e-9;  // m
constexpr std::size_t kMostPoints = 5000000;

/// Steps of an arc so that its chords are off by `error` at most: r (1 − cos(step/2)).
double arc_steps(const Pose<double>& start, const Motion& motion, double error) {
  if (motion.kind != MotionKind::circular) {
    return 1;
  }
  const double radius = (start.position - motion.arc.center).norm();
  const double step = 2 * std::acos(std::max(1 - error / std::max(radius, error), 0.0));
  return motion.arc.angle / step;
}

std::size_t steps_of(const Pose<double>& start, const Motion& motion,
                     const PathSampling& sampling) {
  const double length = programs::length_of(start, motion);
  const double turn = programs::turn_between(start.rotation, motion.end.rotation);
  const double steps = std::max({1.0, length / sampling.largest_step, turn / sampling.largest_turn,
                                 arc_steps(start, motion, sampling.chord_error)});
  constexpr auto kMost = static_cast<double>(kMostPoints);
  return static_cast<std::size_t>(std::ceil(std::min(steps, kMost) - 1e-9));
}

Vector3<double> direction(const Vector3<double>& from, const Vector3<double>& to) {
  const Vector3<double> way = to - from;
  return way.norm() > kStands ? Vector3<double>(way.normalized()) : Vector3<double>::Zero();
}

/// Along the arc at its point, not along a chord.
Vector3<double> tangent(const Pose<double>& start, const Motion& motion, const Pose<double>& at,
                        double share) {
  if (motion.kind != MotionKind::circular) {
    return direction(start.position, motion.end.position);
  }
  const double small = 1e-4;
  const double before = std::max(share - small, 0.0);
  const double after = std::min(share + small, 1.0);
  const Vector3<double> secant = direction(programs::pose_at(start, motion, before).position,
                                           programs::pose_at(start, motion, after).position);
  const Vector3<double> out = (at.position - motion.arc.center).normalized();
  const Vector3<double> radial = out - motion.arc.normal.dot(out) * motion.arc.normal;
  return (secant - secant.dot(radial) * radial / radial.squaredNorm()).normalized();
}

void append(const Pose<double>& start, const Motion& motion, std::size_t index,
            const PathSampling& sampling, std::vector<PathPoint>* points) {
  const std::size_t steps = steps_of(start, motion, sampling);
  for (std::size_t step = 1; step <= steps; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(steps);
    const Pose<double> pose = programs::pose_at(start, motion, share);
    points->push_back({pose, tangent(start, motion, pose, share), index});
  }
}

}  // namespace

double distance(const Pose<double>& from, const Pose<double>& to) {
  return std::max((to.position - from.position).norm(),
                  kTurningLever * programs::turn_between(from.rotation, to.rotation));
}

std::vector<PathPoint> sample(const programs::Program& program, const PathSampling& sampling) {
  std::vector<PathPoint> points;
  if (program.motions.empty()) {
    return points;
  }
  points.push_back({program.motions.front().end, Vector3<double>::Zero(), 0});
  for (std::size_t i = 1; i < program.motions.size(); ++i) {
    const Pose<double>& start = program.motions[i - 1].end;
    const Motion& motion = program.motions[i];
    const bool stands =
        motion.kind != MotionKind::circular && distance(start, motion.end) <= kStands;
    if (!stands) {
      append(start, motion, i, sampling, &points);
      if (points.size() > kMostPoints) {
        programs::refuse(
            program.file, motion.line,
            fmt::format("more than {} points up to here; take a larger --step", kMostPoints));
      }
    }
  }
  return points;
}

}  // namespace flexcomp::planning
