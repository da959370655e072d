#pragma once

#include <array>
#include <cstddef>

#include "messages/messages.hpp"

namespace flexcomp {

constexpr double kDegree = 3.14159265358979323846 / 180;  ///< rad

/// Six angles as a robot controller counts them: degrees.
using AxisAngles = std::array<double, 6>;

/// How a controller counts the axes, against the joints of the URDF:
///
///   joint [rad] = sign · (axis [deg] - zero [deg]) · π / 180
///
/// KUKA's own convention: at all zeros the arm is stretched out horizontally along x of the base;
/// A1 turns about -z, A2, A3 and A5 about y, A4 and A6 about -x. A URDF that follows it, as those
/// of ROS-Industrial and those of host/robots do, needs signs of 1 and zeros of 0.
struct AxisConvention {
  std::array<double, 6> sign = {1, 1, 1, 1, 1, 1};  ///< each 1 or -1
  AxisAngles zero{};  ///< degrees, what the controller shows where the URDF's joint is at zero

  JointAngles to_joints(const AxisAngles& axes) const {
    JointAngles joints{};
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i] = sign[i] * (axes[i] - zero[i]) * kDegree;
    }
    return joints;
  }

  AxisAngles to_axes(const JointAngles& joints) const {
    AxisAngles axes{};
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i] = sign[i] * joints[i] / kDegree + zero[i];
    }
    return axes;
  }

  /// A difference of joint angles: the zeros take no part.
  AxisAngles to_correction(const JointAngles& difference) const {
    AxisAngles correction{};
    for (std::size_t i = 0; i < correction.size(); ++i) {
      correction[i] = sign[i] * difference[i] / kDegree;
    }
    return correction;
  }

  /// The inverse of `to_correction`.
  JointAngles to_difference(const AxisAngles& correction) const {
    JointAngles difference{};
    for (std::size_t i = 0; i < difference.size(); ++i) {
      difference[i] = sign[i] * correction[i] * kDegree;
    }
    return difference;
  }
};

}  // namespace flexcomp
