#include <cmath>
#include <limits>

#include "geometry/profile.hpp"

namespace flexcomp::geometry {
namespace {

/// The best centre found for a part of the points, and the points that fix it.
struct Zone {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double width = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> inner;
  std::vector<std::size_t> outer;
};

/// Where the perpendicular bisectors of two pairs of points meet; false if they are parallel.
bool bisectors_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d, Eigen::Vector2d* center) {
  const long double ux = static_cast<long double>(b.x()) - a.x();
  const long double uy = static_cast<long double>(b.y()) - a.y();
  const long double vx = static_cast<long double>(d.x()) - c.x();
  const long double vy = static_cast<long double>(d.y()) - c.y();
  const long double determinant = ux * vy - uy * vx;
  if (determinant == 0) {
    return false;
  }
  const long double p = (ux * (static_cast<long double>(a.x()) + b.x()) +
                         uy * (static_cast<long double>(a.y()) + b.y())) /
                        2;
  const long double q = (vx * (static_cast<long double>(c.x()) + d.x()) +
                         vy * (static_cast<long double>(c.y()) + d.y())) /
                        2;
  *center = {static_cast<double>((p * vy - q * uy) / determinant),
             static_cast<double>((q * ux - p * vx) / determinant)};
  return center->allFinite();
}

/// Minimum zone of a few points by trying every centre that four contacts can fix: two points on
/// each circle, or three on one and one on the other. Every local optimum is such a centre.
class ZoneOfFew {
 public:
  ZoneOfFew(const Profile& profile, const std::vector<std::size_t>& indices)
      : profile_(profile), indices_(indices) {}

  Zone solve() {
    const std::size_t n = indices_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) {
          try_triple(i, j, k);
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = i; k < n; ++k) {
          for (std::size_t l = k + 1; l < n; ++l) {
            if (k > i || l > j) {
              try_pairs(i, j, k, l);
            }
          }
        }
      }
    }
    return best_;
  }

 private:
  const Eigen::Vector2d& point(std::size_t i) const { return profile_[indices_[i]]; }

  void try_triple(std::size_t i, std::size_t j, std::size_t k) {
    Eigen::Vector2d center;
    if (circumcenter(point(i), point(j), point(k), &center)) {
      consider(center);
    }
  }

  void try_pairs(std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
    if (i == k || i == l || j == k || j == l) {
      return;  // three points in all: a circumcentre, tried already
    }
    Eigen::Vector2d center;
    if (!bisectors_meet(point(i), point(j), point(k), point(l), &center)) {
      return;
    }
    const double gap = std::abs((point(i) - center).norm() - (point(k) - center).norm());
    if (gap < best_.width) {
      consider(center);
    }
  }

  /// Takes the centre if it beats the best so far; gives up at the first point that says it cannot.
  void consider(const Eigen::Vector2d& center) {
    double low = std::numeric_limits<double>::infinity();
    double high = 0;
    for (const std::size_t index : indices_) {
      const double distance = (profile_[index] - center).norm();
      low = std::min(low, distance);
      high = std::max(high, distance);
      if (high - low >= best_.width) {
        return;
      }
    }
    best_.width = high - low;
    best_.center = center;
    best_.inner.clear();
    best_.outer.clear();
    const double contact = 1e-12 * high;
    for (const std::size_t index : indices_) {
      const double distance = (profile_[index] - center).norm();
      if (distance <= low + contact) {
        best_.inner.push_back(index);
      } else if (distance >= high - contact) {
        best_.outer.push_back(index);
      }
    }
  }

  const Profile& profile_;
  const std::vector<std::size_t>& indices_;
  Zone best_;
};

}  // namespace

Circularity minimum_zone_circularity(const Points& points) {
  const Profile profile(points);
  std::vector<std::size_t> unique;
  add_missing(spread_points(profile, least_squares_center(profile), true), &unique);
  // A short arc may spread to two points only, which fix no centre.
  add_missing({profile.triangle().begin(), profile.triangle().end()}, &unique);
  for (;;) {
    const Zone zone = ZoneOfFew(profile, unique).solve();
    const Profile::Range range = profile.range(zone.center);
    if (range.r_max - range.r_min <= zone.width ||
        !add_missing({range.nearest, range.farthest}, &unique)) {
      return profile.about(zone.center, zone.inner, zone.outer);
    }
  }
}

}  // namespace flexcomp::geometry
