#include "study/planar_arm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/chain.hpp"

namespace flexcomp::study {
namespace {

// A share of the reach, and of unit vectors. A point this far beside the plane moves as one in it
// does, to as small a share; models rounded to micrometres, or to six digits of π/2, are within it.
constexpr double kStraight = 1e-4;

Planar in_plane(const Vector3<double>& point) { return {point.x(), point.z()}; }

/// 1 for an axis along −y, which turns x to z; −1 along y.
double turn_of(const Vector3<double>& axis, int joint) {
  if (std::hypot(axis.x(), axis.z()) > kStraight) {
    throw InputError(
        fmt::format("the map is of the plane y = 0, where the axes of joints 2, 3 and 5 are "
                    "parallel to y with all "
                    "joints at 0: here joint {}'s is not; flexcomp map --volume takes any robot",
                    joint));
  }
  return axis.y() < 0 ? 1 : -1;
}

AngleRange range_of(const Joint<double>& joint, double turn) {
  return turn > 0 ? AngleRange(joint.lower, joint.upper) : AngleRange(-joint.upper, -joint.lower);
}

/// The least and the largest distance from joint 2 to the tool point that joint 3 allows.
std::array<double, 2> reach_of(const PlanarArm& arm, double lower, double upper) {
  const auto distance = [&](double angle) {
    return std::abs(arm.upper_arm + std::polar(1.0, angle) * arm.forearm);
  };
  const auto is_allowed = [&](Planar direction) {
    using One = Eigen::Array<double, 1, 1>;
    return arm.range_3.holds(One(direction.real()), One(direction.imag()), 1);
  };
  const Planar along = arm.upper_arm / arm.forearm;
  const Planar stretched = along / std::abs(along);
  return {is_allowed(-stretched) ? std::abs(std::abs(arm.upper_arm) - std::abs(arm.forearm))
                                 : std::min(distance(lower), distance(upper)),
          is_allowed(stretched) ? std::abs(arm.upper_arm) + std::abs(arm.forearm)
                                : std::max(distance(lower), distance(upper))};
}

}  // namespace

AngleRange::AngleRange(double lower, double upper)
    : lower_(std::polar(1.0, lower)), upper_(std::polar(1.0, upper)) {
  const double width = upper - lower;
  kind_ = width >= 2 * M_PI ? Kind::full : width < M_PI ? Kind::narrow : Kind::wide;
}

PlanarArm planar_arm(const RobotModel<double, 6>& model, ToolPoint point, bool limits) {
  const JointVector<double, 6> zero = JointVector<double, 6>::Zero();
  const Kinematics<double, 6> at = forward_kinematics(model, zero);
  const Vector3<double> wrist = at.links[4].position;
  const Vector3<double> tool = point == ToolPoint::wrist ? wrist : at.tcp.position;
  const double length = (tool - at.links[1].position).norm();
  if (std::abs(tool.y()) > kStraight * length && point == ToolPoint::tcp) {
    throw InputError(fmt::format(
        "the map is of the plane y = 0: with all joints at 0 the TCP must lie in it, here it lies "
        "{:.3g} mm beside it; flexcomp map --volume takes any robot",
        1e3 * std::abs(tool.y())));
  }
  PlanarArm arm;
  arm.turn_2 = turn_of(at.axes[1], 2);
  arm.turn_3 = turn_of(at.axes[2], 3);
  turn_of(at.axes[4], 5);
  arm.shoulder = in_plane(at.links[1].position);
  arm.upper_arm = in_plane(at.links[2].position) - arm.shoulder;
  arm.forearm = in_plane(tool - at.links[2].position);
  arm.wrist_to_tool = in_plane(tool - wrist);
  for (std::size_t i = 0; i < 3; ++i) {
    arm.compliance[i] = model.joints[i < 2 ? i + 1 : 4].compliance;
  }
  if (!(std::min(std::abs(arm.upper_arm), std::abs(arm.forearm)) > kStraight * length)) {
    throw InputError("joints 2 and 3, or joint 3 and the tool point, coincide: there is no arm");
  }
  const Joint<double>& elbow = model.joints[2];
  if (limits) {
    arm.range_2 = range_of(model.joints[1], arm.turn_2);
    arm.range_3 = range_of(elbow, arm.turn_3);
  }
  arm.reach = reach_of(arm, arm.turn_3 * elbow.lower, arm.turn_3 * elbow.upper);
  return arm;
}

JointVector<double, 6> PlanarArm::angles(Planar elbow, Planar tool) const {
  const Planar first = (elbow - shoulder) / upper_arm;
  const Planar second = (tool - elbow) / forearm;
  JointVector<double, 6> q = JointVector<double, 6>::Zero();
  q[1] = turn_2 * std::arg(first);
  q[2] = turn_3 * std::arg(second / first);
  return q;
}

}  // namespace flexcomp::study
