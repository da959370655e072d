#pragma once

#include <array>
#include <complex>

#include "flexcomp/model.hpp"

namespace flexcomp::study {

/// A point or a vector in the plane of joints 2 and 3: x + iz, m, base frame.
using Planar = std::complex<double>;

/// The point of the robot that follows the path and takes the force.
enum class ToolPoint {
  wrist,  ///< where the axis of joint 5 meets the plane
  tcp,    ///< the model's TCP: the flange, where the model has no tool
};

/// Directions that a joint can turn an arm to, seen in the plane.
class AngleRange {
 public:
  AngleRange() = default;
  /// Angles in rad, counterclockwise; `lower` ≤ `upper`.
  AngleRange(double lower, double upper);

  bool is_full() const { return kind_ == Kind::full; }
  /// Is the direction (x, z) in the range, to 1e-9 rad? `length` is that of (x, z). Takes arrays
  /// too; then all of them must be.
  template <typename Values>
  bool holds(const Values& x, const Values& z, double length) const;

 private:
  enum class Kind { full, narrow, wide };
  Kind kind_ = Kind::full;
  Planar lower_{1, 0};
  Planar upper_{1, 0};
};

/// A six-axis robot with joints 1, 4, 5 and 6 at zero: two arms that turn about joints 2 and 3, in
/// the plane y = 0 (the posture of Klimchik et al. 2017).
struct PlanarArm {
  Planar shoulder;       ///< axis of joint 2
  Planar upper_arm;      ///< from joint 2 to joint 3, both at zero
  Planar forearm;        ///< from joint 3 to the tool point, both at zero
  Planar wrist_to_tool;  ///< from joint 5 to the tool point, both at zero
  double turn_2 = 1;     ///< 1 where joint 2 turns counterclockwise (x to z), else -1
  double turn_3 = 1;
  AngleRange range_2;  ///< of joint 2's arm, from where it is at zero
  AngleRange range_3;  ///< of the forearm, from where it is at zero beside the upper arm
  std::array<double, 3> compliance{};  ///< rad/(N·m), of joints 2, 3 and 5

  std::array<double, 2> reach{};  ///< m, of the tool point from joint 2: least, largest

  /// Angles (rad, to whole turns) of all joints that put the elbow and the tool point there.
  JointVector<double, 6> angles(Planar elbow, Planar tool) const;
};

/// The arm of a robot, joint limits left out unless wanted. Throws InputError for a robot whose
/// joints 2, 3 and 5 are not parallel to y, or whose tool point is not at y = 0.
PlanarArm planar_arm(const RobotModel<double, 6>& model, ToolPoint point, bool limits);

template <typename Values>
bool AngleRange::holds(const Values& x, const Values& z, double length) const {
  if (kind_ == Kind::full) {
    return true;
  }
  const double slack = 1e-9 * length;
  const Values after_lower = lower_.real() * z - lower_.imag() * x;
  const Values before_upper = x * upper_.imag() - z * upper_.real();
  return kind_ == Kind::narrow ? (after_lower >= -slack).all() && (before_upper >= -slack).all()
                               : ((after_lower >= -slack) || (before_upper >= -slack)).all();
}

}  // namespace flexcomp::study
