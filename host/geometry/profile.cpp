#include "geometry/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "geometry/off_line.hpp"

namespace flexcomp::geometry {
namespace {

std::size_t distinct_up_to_three(const Points& points) {
  Points found;
  for (const Eigen::Vector2d& point : points) {
    if (found.size() < 3 && std::find(found.begin(), found.end(), point) == found.end()) {
      found.push_back(point);
    }
  }
  return found.size();
}

}  // namespace

Profile::Profile(const Points& points) {
  if (!std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); })) {
    throw InputError("a point is not finite");
  }
  if (distinct_up_to_three(points) < 3) {
    throw InputError("fewer than three distinct points have no reference circle");
  }
  Eigen::Vector2d lower = points.front();
  Eigen::Vector2d upper = points.front();
  for (const Eigen::Vector2d& point : points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  origin_ = lower + (upper - lower) / 2;
  points_.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    points_.emplace_back(point - origin_);
    extent_ = std::max(extent_, points_.back().cwiseAbs().maxCoeff());
  }
  refuse_extreme_extent(extent_);
  const OffLine<2> off(points_, std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()));
  off.refuse_a_line("reference circle");
  triangle_ = {off.one_end(), off.other_end(), off.highest()};
}

Profile::Range Profile::range(const Eigen::Vector2d& center) const {
  Range range{0, 0, std::numeric_limits<double>::infinity(), -1};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double squared = (points_[i] - center).squaredNorm();
    if (squared < range.r_min) {
      range.r_min = squared;
      range.nearest = i;
    }
    if (squared > range.r_max) {
      range.r_max = squared;
      range.farthest = i;
    }
  }
  range.r_min = std::sqrt(range.r_min);
  range.r_max = std::sqrt(range.r_max);
  return range;
}

Circularity Profile::about(const Eigen::Vector2d& center, std::vector<std::size_t> inner_support,
                           std::vector<std::size_t> outer_support) const {
  const Range at = range(center);
  return {origin_ + center, at.r_min, at.r_max, std::move(inner_support), std::move(outer_support)};
}

bool circumcenter(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  Eigen::Vector2d* center) {
  // Extended precision: for three neighbours on a circle most digits cancel.
  const long double bx = static_cast<long double>(b.x()) - a.x();
  const long double by = static_cast<long double>(b.y()) - a.y();
  const long double cx = static_cast<long double>(c.x()) - a.x();
  const long double cy = static_cast<long double>(c.y()) - a.y();
  const long double twice_area = bx * cy - by * cx;
  if (twice_area == 0) {
    return false;
  }
  const long double bb = bx * bx + by * by;
  const long double cc = cx * cx + cy * cy;
  *center = {static_cast<double>(a.x() + (cy * bb - by * cc) / (2 * twice_area)),
             static_cast<double>(a.y() + (bx * cc - cx * bb) / (2 * twice_area))};
  return center->allFinite();
}

std::vector<std::size_t> spread_points(const Profile& profile, const Eigen::Vector2d& center,
                                       bool farthest) {
  constexpr std::size_t kDirections = 8;
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::array<std::size_t, kDirections> low;
  std::array<std::size_t, kDirections> high;
  low.fill(kNone);
  high.fill(kNone);
  const auto squared = [&](std::size_t i) { return (profile[i] - center).squaredNorm(); };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d arm = profile[i] - center;
    // Octant from signs and from which coordinate is larger.
    const std::size_t octant = (arm.x() < 0 ? 1U : 0U) + (arm.y() < 0 ? 2U : 0U) +
                               (std::abs(arm.x()) < std::abs(arm.y()) ? 4U : 0U);
    if (low[octant] == kNone || squared(i) < squared(low[octant])) {
      low[octant] = i;
    }
    if (high[octant] == kNone || squared(i) > squared(high[octant])) {
      high[octant] = i;
    }
  }
  std::vector<std::size_t> spread;
  for (std::size_t octant = 0; octant < kDirections; ++octant) {
    if (low[octant] != kNone) {
      spread.push_back(low[octant]);
      if (farthest) {
        spread.push_back(high[octant]);
      }
    }
  }
  return spread;
}

bool add_missing(const std::vector<std::size_t>& candidates, std::vector<std::size_t>* set) {
  const std::size_t before = set->size();
  for (const std::size_t candidate : candidates) {
    if (std::find(set->begin(), set->end(), candidate) == set->end()) {
      set->push_back(candidate);
    }
  }
  return set->size() > before;
}

}  // namespace flexcomp::geometry
