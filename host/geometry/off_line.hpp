#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "error.hpp"

namespace flexcomp::geometry {

/// Throws InputError for an extent of points that is not zero, and whose fourth power no number can
/// hold: what measures form multiplies four lengths.
inline void refuse_extreme_extent(double extent) {
  constexpr double kLongest = 1e70;
  if (!(extent < kLongest) || (extent > 0 && extent < 1 / kLongest)) {
    throw InputError("the points lie too far apart, or too close together, to compute with");
  }
}

/// How far points lie off the line through two of them that are far apart.
template <int Size>
class OffLine {
 public:
  using Point = Eigen::Matrix<double, Size, 1>;

  /// `points`: relative to somewhere among them; `largest`: the largest coordinate as it was given.
  /// Throws InputError for an extreme extent.
  OffLine(const std::vector<Point>& points, double largest) {
    one_end_ = farthest_from(points, points.front());
    other_end_ = farthest_from(points, points[one_end_]);
    const Point along = points[other_end_] - points[one_end_];
    length_ = along.norm();
    refuse_extreme_extent(length_);
    for (std::size_t i = 0; length_ > 0 && i < points.size(); ++i) {
      const Point arm = points[i] - points[one_end_];
      const double off = (arm - along * (along.dot(arm) / (length_ * length_))).norm();
      highest_ = off > height_ ? i : highest_;
      height_ = std::max(height_, off);
    }
    // A coordinate was rounded to the nearest number: half a unit in the last place in each
    // direction. The point and the line below it may both be off by so much, and the arithmetic
    // here adds a little.
    const double unit = std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
    resolution_ = 1.1 * std::sqrt(static_cast<double>(Size)) * unit + 1e-15 * length_;
  }

  std::size_t one_end() const { return one_end_; }
  std::size_t other_end() const { return other_end_; }

  /// The point farthest off the line.
  std::size_t highest() const { return highest_; }

  /// Throws InputError, with what such points do not have, if they lie on a line as far as their
  /// digits tell.
  void refuse_a_line(const std::string& what) const {
    if (height_ > resolution_) {
      return;
    }
    constexpr double kFlat = 1e-2;
    if (height_ > kFlat * length_) {
      throw InputError(
          "the coordinates are too far from zero for their distances: their digits do not tell "
          "whether the points lie on a line");
    }
    throw InputError("points on a line have no " + what);
  }

 private:
  static std::size_t farthest_from(const std::vector<Point>& points, const Point& from) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - from).squaredNorm() > (points[farthest] - from).squaredNorm()) {
        farthest = i;
      }
    }
    return farthest;
  }

  std::size_t one_end_ = 0;
  std::size_t other_end_ = 0;
  std::size_t highest_ = 0;
  double length_ = 0;
  double height_ = 0;
  double resolution_ = 0;
};

}  // namespace flexcomp::geometry
