#pragma once

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// A closed profile as radii over the angle about a centre; between points they run straight.
class PolarProfile {
 public:
  PolarProfile(const Points& points, const Eigen::Vector2d& center);

  double radius(double angle) const;

 private:
  std::vector<double> angles_;  ///< ascending, from −π
  std::vector<double> radii_;
};

/// A closed profile after the Gaussian filter of ISO 16610-21 with a cut-off in undulations per
/// revolution (ISO 12181-2): waves with so many are let through by half, those with less more.
///
/// The radii about the least-squares centre are taken at equal angles, at least 32 to a wave at the
/// cut-off. Throws InputError for a cut-off outside 1 to 10000, and as least squares does.
Points filtered(const Points& points, double cutoff);

}  // namespace flexcomp::geometry
