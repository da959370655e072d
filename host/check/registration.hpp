#pragma once

#include <Eigen/Core>

#include "flexcomp/types.hpp"

namespace flexcomp::check {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// to ≈ scale · rotation · from + translation.
struct Registration {
  Matrix3<double> rotation = Matrix3<double>::Identity();  ///< with determinant −1 where mirrored
  Vector3<double> translation = Vector3<double>::Zero();
  double scale = 1;

  Points of(const Points& from) const;
};

/// The rigid motion (or, `mirrored`, the improper one) that takes points to others with the least
/// squares (Umeyama 1991); with `scaled`, the similarity.
Registration register_points(const Points& from, const Points& to, bool mirrored = false,
                             bool scaled = false);

/// Root mean square extents of points along their principal axes, the largest first.
Vector3<double> extents(const Points& points);

/// Median distance of points from others.
double median_distance(const Points& a, const Points& b);

/// Angle (rad) of a rotation.
double angle_of(const Matrix3<double>& rotation);

}  // namespace flexcomp::check
