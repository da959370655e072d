#pragma once

#include <memory>

#include "study/planar_arm.hpp"

namespace flexcomp::study {

/// How the wrench turns while the tool goes round.
enum class WrenchSense {
  with_path,     ///< as a cutting force does
  against_path,  ///< the other way round: one reading of the study's figures
};

/// A circle to be milled in the plane of joints 2 and 3, from x to z.
struct MilledCircle {
  double radius = 0.1;  ///< m
  int points = 72;
  Vector3<double> force{440, 1370, 635};  ///< N: out of the circle, along the feed, along −y
  Vector3<double> moment{0, 3, 10.5};     ///< N·m, in the same directions
  WrenchSense sense = WrenchSense::with_path;
  ToolPoint point = ToolPoint::wrist;
  bool is_first_order = false;  ///< levers taken at the circle's centre all round, which alone must
                                ///< be in reach; otherwise at each point, and all must be
  bool has_limits = true;       ///< within the joint limits
};

/// Throws InputError for a circle that cannot be milled, or that no load bends.
void check(const MilledCircle& circle);

/// The circularity (LSC) that milled circles have when the robot is not corrected, anywhere in its
/// plane: p = p0 + R r + C(p) R w with C = J K⁻¹ Jᵀ (Klimchik et al. 2017, eq. 15).
///
/// With springs in joints alone, and no weight, only joints 2, 3 and 5 move the point in the plane:
/// by i a (Im(conj(a) F) + M) k each, a the lever from the joint to the point. Else the core's own
/// deflection is taken at each point.
class CircleStudy {
 public:
  /// Throws InputError for a robot or a circle that has no such study.
  CircleStudy(const RobotModel<double, 6>& model, const MilledCircle& circle);
  CircleStudy(CircleStudy&& other) noexcept;
  ~CircleStudy();

  /// m, for a circle about a centre; NaN where out of reach. The elbow is on the left of the line
  /// from joint 2 to the point (up, in front of the robot), on the right only where joint limits
  /// leave no other way. May be called from several threads.
  double circularity(Planar center) const;

  const PlanarArm& arm() const;

 private:
  class Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace flexcomp::study
