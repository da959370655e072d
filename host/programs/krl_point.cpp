#include "programs/krl_point.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "files/one_line.hpp"
#include "programs/program.hpp"

namespace flexcomp::programs {
namespace {

/// Which of six components a letter and a digit from 1 to 6 name; nothing for another name.
std::optional<std::size_t> axis_of(const std::string& name, char letter) {
  const bool is_axis = name.size() == 2 && name[0] == letter && name[1] >= '1' && name[1] <= '6';
  return is_axis ? std::optional<std::size_t>(static_cast<std::size_t>(name[1] - '1'))
                 : std::nullopt;
}

/// Takes a component into a point; false where a point has none of this name.
bool take_component(const KrlComponent& component, KrlPoint* point) {
  constexpr std::string_view kNames = "XYZABC";
  const std::string& name = component.name;
  const std::size_t at = name.size() == 1 ? kNames.find(name[0]) : std::string_view::npos;
  if (at != std::string_view::npos) {
    point->frame[at] = component.number;
  } else if (const auto axis = axis_of(name, 'E')) {
    point->external[*axis] = component.number;
  } else if (axis_of(name, 'A')) {
    point->has_axes = true;
  } else if (name == "S" || name == "T") {
    point->has_posture = true;
    return true;
  } else {
    return false;
  }
  return true;
}

}  // namespace

bool KrlPoint::is_whole() const {
  return std::all_of(frame.begin(), frame.end(), [](const auto& each) { return each.has_value(); });
}

void KrlPoint::fill_from(const KrlPoint& other) {
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!frame[i]) {
      frame[i] = other.frame[i];
    }
  }
}

Pose<double> KrlPoint::pose() const {
  using Eigen::AngleAxisd;
  using Vector = Vector3<double>;
  return {(AngleAxisd(*frame[3] * kDegree, Vector::UnitZ()) *
           AngleAxisd(*frame[4] * kDegree, Vector::UnitY()) *
           AngleAxisd(*frame[5] * kDegree, Vector::UnitX()))
              .toRotationMatrix(),
          kMillimetre * Vector(*frame[0], *frame[1], *frame[2])};
}

std::optional<KrlPoint> krl_point_of(const std::vector<KrlComponent>& aggregate, std::string* why) {
  constexpr double kLargest = 1e9;
  constexpr std::size_t kMost = 20;  // X to C, S, T, six axes of the robot or six beside it
  KrlPoint point;
  if (aggregate.size() > kMost) {
    return std::nullopt;
  }
  for (auto each = aggregate.begin(); each != aggregate.end(); ++each) {
    const bool is_posture = each->name == "S" || each->name == "T";
    if (!take_component(*each, &point)) {
      *why = fmt::format("'{}' is no component of a point", files::one_line(each->name, 30));
      return std::nullopt;
    }
    if (!is_posture && (!each->number || std::abs(*each->number) > kLargest)) {
      return std::nullopt;
    }
    if (std::any_of(aggregate.begin(), each,
                    [&](const KrlComponent& before) { return before.name == each->name; })) {
      *why = fmt::format("'{}' stands twice in a point", each->name);
      return std::nullopt;
    }
  }
  return point;
}

KrlPoint krl_point_at(const Pose<double>& pose) {
  const std::array<double, 3> angles = krl_angles(pose.rotation);
  const Vector3<double> place = pose.position / kMillimetre;
  KrlPoint point;
  point.frame = {place.x(), place.y(), place.z(), angles[0], angles[1], angles[2]};
  return point;
}

std::array<double, 3> krl_angles(const Matrix3<double>& rotation) {
  const double across = std::hypot(rotation(0, 0), rotation(1, 0));
  const double b = std::atan2(-rotation(2, 0), across);
  const bool is_upright = across < 1e-9;
  const double a = is_upright ? 0 : std::atan2(rotation(1, 0), rotation(0, 0));
  const double c = is_upright ? std::atan2(-rotation(1, 2), rotation(1, 1))
                              : std::atan2(rotation(2, 1), rotation(2, 2));
  return {a / kDegree, b / kDegree, c / kDegree};
}

}  // namespace flexcomp::programs
