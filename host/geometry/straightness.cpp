#include "geometry/straightness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "geometry/convex_hull.hpp"
#include "geometry/off_line.hpp"

namespace flexcomp::geometry {
namespace {

/// Where differences between the points are to be taken from; refuses what has no line.
Eigen::Vector2d mean_of(const Points& points) {
  if (!std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); })) {
    throw InputError("a point is not finite");
  }
  if (points.empty() || std::all_of(points.begin(), points.end(),
                                    [&](const auto& p) { return p == points.front(); })) {
    throw InputError("fewer than two distinct points have no reference line");
  }
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    sum += point - points.front();
  }
  const Eigen::Vector2d mean = points.front() + sum / static_cast<double>(points.size());
  double extent = 0;
  for (const Eigen::Vector2d& point : points) {
    extent = std::max(extent, (point - mean).cwiseAbs().maxCoeff());
  }
  refuse_extreme_extent(mean.allFinite() ? extent : mean.norm());
  return mean;
}

/// The deviations about a line; the support is left empty.
Straightness about(const Points& points, const Eigen::Vector2d& point,
                   const Eigen::Vector2d& direction) {
  Straightness line{point,
                    direction,
                    std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity(),
                    {}};
  for (const Eigen::Vector2d& each : points) {
    const double deviation = cross(direction, each - point);
    line.low = std::min(line.low, deviation);
    line.high = std::max(line.high, deviation);
  }
  return line;
}

}  // namespace

Straightness least_squares_straightness(const Points& points) {
  const Eigen::Vector2d mean = mean_of(points);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& point : points) {
    moments += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moments);
  Straightness line = about(points, mean, axes.eigenvectors().col(1));
  const auto deviates_less = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return cross(line.direction, a - mean) < cross(line.direction, b - mean);
  };
  const auto [least, most] = std::minmax_element(points.begin(), points.end(), deviates_less);
  line.support = {static_cast<std::size_t>(least - points.begin()),
                  static_cast<std::size_t>(most - points.begin())};
  return line;
}

Straightness minimum_zone_straightness(const Points& points) {
  const Eigen::Vector2d mean = mean_of(points);
  Points centered;
  centered.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    centered.emplace_back(point - mean);
  }
  const std::vector<std::size_t> hull = convex_hull(centered);
  const std::size_t n = hull.size();
  const auto corner = [&](std::size_t i) { return centered[hull[i % n]]; };
  Straightness best;
  double least = std::numeric_limits<double>::infinity();
  std::size_t opposite = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d edge = (corner(i + 1) - corner(i)).normalized();
    const auto height = [&](std::size_t k) { return cross(edge, corner(k) - corner(i)); };
    // The farthest corner only moves on as the edge goes round.
    opposite = std::max(opposite, i + 1);
    while (opposite < i + n && height(opposite + 1) >= height(opposite)) {
      ++opposite;
    }
    if (height(opposite) < least) {
      least = height(opposite);
      best = about(centered, corner(i), edge);
      best.support = {hull[i], hull[(i + 1) % n], hull[opposite % n]};
    }
  }
  best.point += mean;
  return best;
}

}  // namespace flexcomp::geometry
