#include "planning/closed_form.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>

namespace flexcomp::planning {
namespace {

using Angles = JointVector<double, 6>;
using Planar = std::complex<double>;  // x + iz

constexpr double kStraight = 1e-9;  // m, and of unit vectors

/// Does a line through a point, along a unit vector, pass through another point?
bool passes(const Vector3<double>& point, const Vector3<double>& axis,
            const Vector3<double>& other) {
  return axis.cross(other - point).norm() < kStraight;
}

bool is_along(const Vector3<double>& axis, const Vector3<double>& other) {
  return axis.cross(other).norm() < kStraight;
}

/// Can the robot, here at zero, be solved so?
bool has_closed_form(const Kinematics<double, 6>& at) {
  const Vector3<double>& wrist = at.links[4].position;
  return is_along(at.axes[0], Vector3<double>::UnitZ()) &&
         passes(at.links[0].position, at.axes[0], Vector3<double>::Zero()) &&
         is_along(at.axes[1], Vector3<double>::UnitY()) &&
         is_along(at.axes[2], Vector3<double>::UnitY()) && std::abs(wrist.y()) < kStraight &&
         passes(at.links[3].position, at.axes[3], wrist) &&
         passes(at.links[5].position, at.axes[5], wrist) &&
         std::abs(at.axes[3].dot(at.axes[4])) < kStraight && is_along(at.axes[3], at.axes[5]);
}

Matrix3<double> turn(const Vector3<double>& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Joints 4 to 6, both ways, for a hand that is to turn so (base frame) from where it is with them
/// at zero. In line with joint 4, joint 6 turns alone.
void add_wrists(const Kinematics<double, 6>& at, const Matrix3<double>& hand, Angles q,
                std::vector<Angles>* all) {
  const Vector3<double>& axis = at.axes[3];
  const Vector3<double> side = at.axes[4].cross(axis);
  const Vector3<double> up = axis.cross(side);
  const Vector3<double> aim = hand * axis;
  const double across = std::hypot(aim.dot(side), aim.dot(up));
  for (const double sign : {1.0, -1.0}) {
    q[3] = across > kStraight ? std::atan2(sign * aim.dot(up), sign * aim.dot(side)) : 0;
    q[4] = std::atan2(sign * across, aim.dot(axis));
    const Matrix3<double> rest = (turn(axis, q[3]) * turn(at.axes[4], q[4])).transpose() * hand;
    const Vector3<double> turned = rest * side;
    q[5] = std::atan2(turned.dot(at.axes[5].cross(side)), turned.dot(side));
    all->push_back(q);
  }
}

}  // namespace

std::optional<std::vector<Angles>> solve_closed_form(const RobotModel<double, 6>& model,
                                                     const Pose<double>& target) {
  const Kinematics<double, 6> zero = forward_kinematics<double, 6>(model, Angles::Zero());
  if (!has_closed_form(zero)) {
    return std::nullopt;
  }
  const auto in_plane = [](const Vector3<double>& point) { return Planar(point.x(), point.z()); };
  const Planar shoulder = in_plane(zero.links[1].position);
  const Planar upper_arm = in_plane(zero.links[2].position) - shoulder;
  const Planar forearm = in_plane(zero.links[4].position - zero.links[2].position);
  const Vector3<double> wrist = target.position + target.rotation * zero.tcp.rotation.transpose() *
                                                      (zero.links[4].position - zero.tcp.position);
  std::vector<Angles> all;
  for (const double way : {1.0, -1.0}) {
    const double out = way * std::hypot(wrist.x(), wrist.y());
    const Planar reach = Planar(out, wrist.z()) - shoulder;
    const double square = std::norm(reach);
    const double along = (std::norm(upper_arm) - std::norm(forearm) + square) / (2 * square);
    const double height = std::norm(upper_arm) / square - along * along;
    if (!(height >= 0)) {
      continue;
    }
    for (const double elbow : {1.0, -1.0}) {
      const Planar first = reach * Planar(along, elbow * std::sqrt(height)) / upper_arm;
      const Planar second = (reach - first * upper_arm) / forearm;
      Angles q = Angles::Zero();
      // From x to z is the negative sense about y.
      q[0] = zero.axes[0].z() * std::atan2(way * wrist.y(), way * wrist.x());
      q[1] = -zero.axes[1].y() * std::arg(first);
      q[2] = -zero.axes[2].y() * std::arg(second / first);
      const Kinematics<double, 6> at = forward_kinematics<double, 6>(model, q);
      add_wrists(at, target.rotation * at.tcp.rotation.transpose(), q, &all);
    }
  }
  return all;
}

}  // namespace flexcomp::planning
