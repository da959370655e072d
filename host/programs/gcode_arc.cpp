#include "programs/gcode_arc.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace flexcomp::programs {
namespace {

constexpr double kSamePoint = 1e-9;  // m

Vector3<double> in_plane(const ArcRequest& request, Vector3<double> v) {
  v[request.normal] = 0;
  return v;
}

Arc about(const ArcRequest& request, const Vector3<double>& center) {
  Arc arc;
  arc.center = center;
  arc.center[request.normal] = request.start[request.normal];
  arc.normal = (request.is_clockwise ? -1 : 1) * Vector3<double>::Unit(request.normal);
  const Vector3<double> from = in_plane(request, request.start - center);
  const Vector3<double> to = in_plane(request, request.end - center);
  arc.angle = std::atan2(arc.normal.dot(from.cross(to)), from.dot(to));
  if (in_plane(request, request.end - request.start).norm() <= kSamePoint) {
    arc.angle = 2 * M_PI;
  } else if (arc.angle <= 0) {
    arc.angle += 2 * M_PI;
  }
  return arc;
}

}  // namespace

std::string arc_by_center(const ArcRequest& request, const Vector3<double>& center, Arc* arc) {
  const double radius = in_plane(request, request.start - center).norm();
  const double off = std::abs(in_plane(request, request.end - center).norm() - radius);
  if (!(radius > kSamePoint)) {
    return "an arc about the point where it begins";
  }
  if (off > 5e-4 || (off > 5e-6 && off > 1e-3 * radius)) {
    return fmt::format("start and end of the arc are not equally far from its middle: by {:.4g} mm",
                       1e3 * off);
  }
  *arc = about(request, center);
  return {};
}

std::string arc_by_radius(const ArcRequest& request, double radius, Arc* arc) {
  constexpr double kRounding = 5e-6;  // m
  const Vector3<double> chord = in_plane(request, request.end - request.start);
  const double half = chord.norm() / 2;
  if (!(half > kSamePoint)) {
    return "an arc by R needs an end other than its start";
  }
  if (std::abs(radius) < half - kRounding) {
    return fmt::format("R is too small for an arc to this end: {:.6g} mm, of {:.6g} mm at least",
                       1e3 * std::abs(radius), 1e3 * half);
  }
  const bool is_left = request.is_clockwise != (radius > 0);
  const Vector3<double> left =
      Vector3<double>(Vector3<double>::Unit(request.normal)).cross(chord).normalized();
  const double height = std::sqrt(std::max(radius * radius - half * half, 0.0));
  *arc = about(request, request.start + chord / 2 + (is_left ? height : -height) * left);
  return {};
}

}  // namespace flexcomp::programs
