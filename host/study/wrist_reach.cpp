#include "study/wrist_reach.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "error.hpp"
#include "flexcomp/chain.hpp"
#include "study/planar_arm.hpp"

namespace flexcomp::study {
namespace {

constexpr double kOnAxis = 1e-9;  // m, and of unit vectors

/// Does a line through a point, along a unit vector, pass through another point?
bool passes(const Vector3<double>& point, const Vector3<double>& axis,
            const Vector3<double>& other) {
  return axis.cross(other - point).norm() < kOnAxis;
}

bool has_arm_and_wrist(const Kinematics<double, 6>& at) {
  const Vector3<double>& wrist = at.links[4].position;
  return passes(at.links[3].position, at.axes[3], wrist) &&
         passes(at.links[5].position, at.axes[5], wrist) &&
         passes(at.links[0].position, at.axes[0], Vector3<double>::Zero()) &&
         std::abs(std::abs(at.axes[0].z()) - 1) < kOnAxis && std::abs(wrist.y()) < kOnAxis;
}

std::optional<PlanarArm> arm_of(const RobotModel<double, 6>& model, bool limits) {
  try {
    return planar_arm(model, ToolPoint::wrist, limits);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

WristReach::WristReach(const RobotModel<double, 6>& model, bool limits) {
  const Kinematics<double, 6> at =
      forward_kinematics(model, JointVector<double, 6>(JointVector<double, 6>::Zero()));
  const std::optional<PlanarArm> arm = arm_of(model, limits);
  if (!arm || !has_arm_and_wrist(at)) {
    return;
  }
  is_known_ = true;
  wrist_ = at.tcp.rotation.transpose() * (at.links[4].position - at.tcp.position);
  shoulder_out_ = arm->shoulder.real();
  shoulder_up_ = arm->shoulder.imag();
  nearest_ = arm->reach[0];
  farthest_ = arm->reach[1];
}

bool WristReach::may_hold(const Pose<double>& tcp) const {
  constexpr double kSlack = 1e-6;  // m
  if (!is_known_) {
    return true;
  }
  const Vector3<double> wrist = tcp.position + tcp.rotation * wrist_;
  const double up = wrist.z() - shoulder_up_;
  const double out = std::hypot(wrist.x(), wrist.y());
  // The arm may also reach backwards over joint 1.
  for (const double side : {out, -out}) {
    const double distance = std::hypot(side - shoulder_out_, up);
    if (distance > nearest_ - kSlack && distance < farthest_ + kSlack) {
      return true;
    }
  }
  return false;
}

}  // namespace flexcomp::study
