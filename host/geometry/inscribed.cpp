#include <algorithm>
#include <cmath>

#include "geometry/convex_hull.hpp"
#include "geometry/profile.hpp"

namespace flexcomp::geometry {
namespace {

/// An empty circle with its centre in the hull.
struct EmptyCircle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 0;
  std::vector<std::size_t> support;
};

/// Largest circle with its centre in the hull that holds none of a few points.
///
/// Inside the hull it touches three points and has its centre in their triangle. On an edge of the
/// hull it can be no larger than half the edge, so only long edges, as across the gap of an arc,
/// are looked at.
class EmptyCircleOfFew {
 public:
  EmptyCircleOfFew(const Profile& profile, const std::vector<std::size_t>& hull,
                   std::vector<std::size_t>* indices)
      : profile_(profile), hull_(hull), indices_(*indices) {}

  /// Ends of long edges join the few points; then all is tried again with them.
  EmptyCircle solve() {
    bool complete = false;
    while (!complete) {
      best_ = EmptyCircle{};
      try_triples();
      complete = try_edges();
    }
    return best_;
  }

 private:
  void try_triples() {
    const std::size_t n = indices_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) {
          try_triple(indices_[i], indices_[j], indices_[k]);
        }
      }
    }
  }

  /// False if an end of a long edge was not among the points yet.
  bool try_edges() {
    bool complete = true;
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      const std::size_t a = hull_[i];
      const std::size_t b = hull_[(i + 1) % hull_.size()];
      if ((profile_[b] - profile_[a]).norm() / 2 > best_.radius) {
        complete = !add_missing({a, b}, &indices_) && complete;
        try_edge(a, b);
      }
    }
    return complete;
  }

  void try_triple(std::size_t a, std::size_t b, std::size_t c) {
    const Eigen::Vector2d ab = profile_[b] - profile_[a];
    const Eigen::Vector2d ac = profile_[c] - profile_[a];
    const Eigen::Vector2d bc = profile_[c] - profile_[b];
    const bool center_inside = ab.dot(ac) >= 0 && ab.dot(bc) <= 0 && ac.dot(bc) >= 0;
    Eigen::Vector2d center;
    if (center_inside && circumcenter(profile_[a], profile_[b], profile_[c], &center)) {
      consider(center, {a, b, c});
    }
  }

  /// Along an edge the largest circle touches two points, at the foot of their bisector.
  void try_edge(std::size_t a, std::size_t b) {
    const Eigen::Vector2d origin = profile_[a];
    const Eigen::Vector2d along = profile_[b] - origin;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      for (std::size_t j = i + 1; j < indices_.size(); ++j) {
        const Eigen::Vector2d p = profile_[indices_[i]] - origin;
        const Eigen::Vector2d q = profile_[indices_[j]] - origin;
        const double slope = 2 * along.dot(q - p);
        const double t = (q.squaredNorm() - p.squaredNorm()) / slope;
        if (slope != 0 && t >= 0 && t <= 1) {
          consider(origin + t * along, {indices_[i], indices_[j]});
        }
      }
    }
  }

  void consider(const Eigen::Vector2d& center, std::vector<std::size_t> support) {
    double radius = (profile_[support.front()] - center).norm();
    for (const std::size_t index : support) {
      radius = std::min(radius, (profile_[index] - center).norm());
    }
    if (radius <= best_.radius) {
      return;
    }
    const double empty = radius * radius * (1 - 1e-14);
    for (const std::size_t index : indices_) {
      if ((profile_[index] - center).squaredNorm() < empty) {
        return;
      }
    }
    best_ = {center, radius, std::move(support)};
  }

  const Profile& profile_;
  const std::vector<std::size_t>& hull_;
  std::vector<std::size_t>& indices_;
  EmptyCircle best_;
};

}  // namespace

Circularity maximum_inscribed_circularity(const Points& points) {
  const Profile profile(points);
  const std::vector<std::size_t> hull = convex_hull(profile.points());
  std::vector<std::size_t> few;
  add_missing(spread_points(profile, least_squares_center(profile), false), &few);
  for (;;) {
    const EmptyCircle circle = EmptyCircleOfFew(profile, hull, &few).solve();
    const Profile::Range range = profile.range(circle.center);
    if (range.r_min >= circle.radius * (1 - 1e-14) || !add_missing({range.nearest}, &few)) {
      return profile.about(circle.center, circle.support, {range.farthest});
    }
  }
}

}  // namespace flexcomp::geometry
