#pragma once

#include <array>

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// Points moved to about their middle, so that differences keep all their digits.
class Profile {
 public:
  /// Throws InputError for points that have no reference circle (see circularity.hpp).
  explicit Profile(const Points& points);

  const Points& points() const { return points_; }
  std::size_t size() const { return points_.size(); }
  const Eigen::Vector2d& operator[](std::size_t i) const { return points_[i]; }

  /// Largest coordinate: the scale of the profile.
  double extent() const { return extent_; }

  /// Three points that do not lie on a line, far from each other.
  const std::array<std::size_t, 3>& triangle() const { return triangle_; }

  struct Range {
    std::size_t nearest;
    std::size_t farthest;
    double r_min;
    double r_max;
  };

  /// Nearest and farthest point from a centre.
  Range range(const Eigen::Vector2d& center) const;

  /// The result for a centre in the profile's own coordinates.
  Circularity about(const Eigen::Vector2d& center, std::vector<std::size_t> inner_support,
                    std::vector<std::size_t> outer_support) const;

 private:
  Eigen::Vector2d origin_;
  Points points_;
  double extent_ = 0;
  std::array<std::size_t, 3> triangle_{};
};

/// Centre of the circle through three points; false if they lie on a line.
bool circumcenter(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  Eigen::Vector2d* center);

/// A few points spread around a centre: in each of eight directions the nearest and, if wanted, the
/// farthest. A good start for growing a set that fixes a reference circle.
std::vector<std::size_t> spread_points(const Profile& profile, const Eigen::Vector2d& center,
                                       bool farthest);

/// Adds indices to a set that are not in it yet; tells whether there were any.
bool add_missing(const std::vector<std::size_t>& candidates, std::vector<std::size_t>* set);

/// Centre by least squares, in the profile's coordinates.
Eigen::Vector2d least_squares_center(const Profile& profile);

}  // namespace flexcomp::geometry
