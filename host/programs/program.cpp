#include "programs/program.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace flexcomp::programs {
namespace {

using Vector = Vector3<double>;

Matrix3<double> between(const Matrix3<double>& from, const Matrix3<double>& to, double share) {
  if (from == to) {
    return to;
  }
  return Eigen::Quaterniond(from)
      .slerp(share, Eigen::Quaterniond(to))
      .normalized()
      .toRotationMatrix();
}

/// A point by its height over the circle's plane and what it is off the axis.
struct OnCircle {
  OnCircle(const Arc& arc, const Vector& point)
      : height(arc.normal.dot(point - arc.center)),
        off(point - arc.center - height * arc.normal),
        radius(off.norm()) {}

  double height;
  Vector off;
  double radius;
};

/// The radius goes over from that of the start to that of the end, which differ by a program's
/// rounding.
Vector on_arc(const Vector& start, const Motion& motion, double share) {
  const OnCircle from(motion.arc, start);
  const OnCircle to(motion.arc, motion.end.position);
  const double radius = from.radius + share * (to.radius - from.radius);
  const double height = from.height + share * (to.height - from.height);
  return motion.arc.center + height * motion.arc.normal +
         Eigen::AngleAxisd(share * motion.arc.angle, motion.arc.normal) * from.off.normalized() *
             radius;
}

}  // namespace

Pose<double> pose_at(const Pose<double>& start, const Motion& motion, double share) {
  if (share >= 1) {
    return motion.end;
  }
  const Vector position =
      motion.kind == MotionKind::circular
          ? on_arc(start.position, motion, share)
          : Vector(start.position + share * (motion.end.position - start.position));
  return {between(start.rotation, motion.end.rotation, share), position};
}

double length_of(const Pose<double>& start, const Motion& motion) {
  if (motion.kind != MotionKind::circular) {
    return (motion.end.position - start.position).norm();
  }
  const OnCircle from(motion.arc, start.position);
  const OnCircle to(motion.arc, motion.end.position);
  return std::hypot((from.radius + to.radius) / 2 * motion.arc.angle, to.height - from.height);
}

double turn_between(const Matrix3<double>& from, const Matrix3<double>& to) {
  const double chord = (to - from).norm() / std::sqrt(8.0);  // the sine of half the angle
  return 2 * std::asin(std::min(chord, 1.0));
}

double way_of(const Pose<double>& start, const Motion& motion) {
  return std::max(length_of(start, motion),
                  kTurningLever * turn_between(start.rotation, motion.end.rotation));
}

std::optional<Arc> arc_through(const Vector& start, const Vector& between, const Vector& end) {
  const Vector first = between - start;
  const Vector second = end - start;
  const Vector across = first.cross(second);
  const double size = first.norm() * second.norm();
  if (!(across.norm() > 1e-9 * size) || !(size > 0)) {
    return std::nullopt;
  }
  Arc arc;
  arc.normal = across.normalized();
  arc.center = start + (second.squaredNorm() * across.cross(first) +
                        first.squaredNorm() * second.cross(across)) /
                           (2 * across.squaredNorm());
  const Vector from = start - arc.center;
  const Vector to = end - arc.center;
  arc.angle = std::atan2(arc.normal.dot(from.cross(to)), from.dot(to));
  if (arc.angle <= 0) {
    arc.angle += 2 * M_PI;
  }
  return arc;
}

void go_round(const Pose<double>& start, double angle, Motion* motion) {
  if (angle < 0) {
    motion->arc.normal = -motion->arc.normal;
  }
  motion->arc.angle = std::abs(angle);
  Motion further = *motion;
  further.arc.angle = 2 * motion->arc.angle;
  motion->end.position = pose_at(start, further, 0.5).position;
}

Matrix3<double> orientation_by_axis(const Vector& axis) {
  const Matrix3<double> down = Eigen::AngleAxisd(M_PI, Vector::UnitX()).toRotationMatrix();
  return Eigen::Quaterniond::FromTwoVectors(Vector::UnitZ(), axis).toRotationMatrix() * down;
}

Program unread(Format format, const std::string& file, std::string text) {
  Program program;
  program.format = format;
  program.file = file;
  program.text = std::move(text);
  return program;
}

void append(const Motion& motion, Program* program) {
  constexpr double kFarthest = 1e5;  // m
  constexpr double kFastest = 1e4;   // m/s, rad/s
  if (!(motion.end.position.cwiseAbs().maxCoeff() <= kFarthest)) {
    refuse(program->file, motion.line, "no machine reaches so far");
  }
  if (!(motion.feed <= kFastest && motion.turn_feed <= kFastest)) {
    refuse(program->file, motion.line, "no machine feeds so fast");
  }
  program->motions.push_back(motion);
}

void refuse(const std::string& file, std::size_t line, const std::string& why) {
  throw InputError(fmt::format("{}:{}: {}", file, line, why));
}

}  // namespace flexcomp::programs
