#include "controller/kuka_axes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "flexcomp/chain.hpp"

namespace flexcomp::controller {
namespace {

using Vector = Vector3<double>;

constexpr double kParallel = 1e-4;  // of a unit vector, aside

bool is_along(const Vector& axis, const Vector& direction) {
  return axis.cross(direction).norm() < kParallel;
}

double sign_of(double number) { return number < 0 ? -1 : 1; }

/// Degrees by which x has to turn about y to point there.
double pitch(const Vector& direction) {
  return std::atan2(-direction.z(), direction.x()) / kDegree;
}

/// To a millionth of a degree, within half a turn.
double rounded(double degrees) {
  constexpr double kUnit = 1e-6;
  const double turned = std::remainder(degrees, 360);
  return std::round(turned / kUnit) * kUnit + 0.0;
}

/// The axis, turned round where it points against `along`; zero if it is square to it.
Vector pointing(const Vector& axis, const Vector& along) {
  const double length = axis.dot(along);
  return std::abs(length) < kParallel ? Vector(Vector::Zero()) : Vector(sign_of(length) * axis);
}

}  // namespace

std::optional<AxisConvention> kuka_axes(const RobotModel<double, 6>& model) {
  const Kinematics<double, 6> at_zero =
      forward_kinematics<double, 6>(model, JointVector<double, 6>::Zero());
  const auto& axes = at_zero.axes;
  const auto origin = [&](std::size_t joint) -> Vector { return at_zero.links[joint].position; };
  const bool is_level = is_along(axes[0], Vector::UnitZ()) && is_along(axes[1], Vector::UnitY()) &&
                        is_along(axes[2], Vector::UnitY()) && is_along(axes[4], Vector::UnitY());
  const Vector arm = origin(2) - origin(1);
  const Vector forearm = pointing(axes[3], origin(4) - origin(2));
  const Vector hand = pointing(axes[5], at_zero.tcp.position - origin(4));
  const bool lies_in_plane = std::abs(forearm.y()) < kParallel && std::abs(hand.y()) < kParallel;
  if (!is_level || !lies_in_plane || arm.norm() < kParallel || forearm.isZero() || hand.isZero()) {
    return std::nullopt;
  }
  AxisConvention result;
  result.sign = {-sign_of(axes[0].z()),          sign_of(axes[1].y()), sign_of(axes[2].y()),
                 -sign_of(axes[3].dot(forearm)), sign_of(axes[4].y()), -sign_of(axes[5].dot(hand))};
  result.zero[1] = rounded(pitch(arm));
  result.zero[2] = rounded(pitch(forearm) - pitch(arm));
  result.zero[4] = rounded(pitch(hand) - pitch(forearm));
  return result;
}

std::string list_of(const std::array<double, 6>& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += fmt::format("{}{:g}", text.empty() ? "" : ", ", number);
  }
  return text;
}

}  // namespace flexcomp::controller
