#include <algorithm>
#include <random>

#include "geometry/profile.hpp"

namespace flexcomp::geometry {
namespace {

/// Smallest circle through up to three points that is known to enclose some of the others.
struct Circle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double squared_radius = -1;
  std::vector<std::size_t> support;

  /// The margin lets the points on the circle itself count as inside in spite of rounding.
  bool encloses(const Eigen::Vector2d& point) const {
    return (point - center).squaredNorm() <= squared_radius * (1 + 1e-14);
  }
};

Circle through(const Profile& profile, std::size_t a, std::size_t b) {
  const Eigen::Vector2d center = profile[a] + (profile[b] - profile[a]) / 2;
  return {center,
          std::max((profile[a] - center).squaredNorm(), (profile[b] - center).squaredNorm()),
          {a, b}};
}

/// Smallest circle around three points, through all of them or, if that does it, through two.
Circle around(const Profile& profile, std::size_t a, std::size_t b, std::size_t c) {
  Circle circle{Eigen::Vector2d::Zero(), 0, {a, b, c}};
  if (!circumcenter(profile[a], profile[b], profile[c], &circle.center)) {
    Circle best;
    for (const Circle& pair :
         {through(profile, a, b), through(profile, a, c), through(profile, b, c)}) {
      best = pair.squared_radius > best.squared_radius ? pair : best;
    }
    return best;
  }
  for (const std::size_t i : circle.support) {
    circle.squared_radius =
        std::max(circle.squared_radius, (profile[i] - circle.center).squaredNorm());
  }
  return circle;
}

/// Smallest enclosing circle of the points in `order`, added one by one in random order.
Circle enclose(const Profile& profile, const std::vector<std::size_t>& order) {
  Circle circle{profile[order[0]], 0, {order[0]}};
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (circle.encloses(profile[order[i]])) {
      continue;
    }
    circle = {profile[order[i]], 0, {order[i]}};
    for (std::size_t j = 0; j < i; ++j) {
      if (circle.encloses(profile[order[j]])) {
        continue;
      }
      circle = through(profile, order[i], order[j]);
      for (std::size_t k = 0; k < j; ++k) {
        if (!circle.encloses(profile[order[k]])) {
          circle = around(profile, order[i], order[j], order[k]);
        }
      }
    }
  }
  return circle;
}

}  // namespace

Circularity minimum_circumscribed_circularity(const Points& points) {
  const Profile profile(points);
  std::vector<std::size_t> order(profile.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  // A fixed seed: the same points give the same answer.
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  const Circle circle = enclose(profile, order);
  const Profile::Range range = profile.range(circle.center);
  return profile.about(circle.center, {range.nearest}, circle.support);
}

}  // namespace flexcomp::geometry
