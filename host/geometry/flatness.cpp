#include "geometry/flatness.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "geometry/off_line.hpp"
#include "geometry/profile.hpp"

namespace flexcomp::geometry {
namespace {

/// Points about their mean, and their principal axes.
struct Surface {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  SpacePoints points;
  Eigen::Matrix3d axes;  ///< columns, the direction of least spread first

  explicit Surface(const SpacePoints& given) {
    if (!std::all_of(given.begin(), given.end(), [](const auto& p) { return p.allFinite(); })) {
      throw InputError("a point is not finite");
    }
    if (given.size() < 3) {
      throw InputError("fewer than three points have no reference plane");
    }
    for (const Eigen::Vector3d& point : given) {
      mean += point - given.front();
    }
    mean = given.front() + mean / static_cast<double>(given.size());
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    double largest = 0;
    for (const Eigen::Vector3d& point : given) {
      points.emplace_back(point - mean);
      moments += points.back() * points.back().transpose();
      largest = std::max(largest, point.cwiseAbs().maxCoeff());
    }
    OffLine<3>(points, largest).refuse_a_line("reference plane");
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
    axes = solver.eigenvectors();
  }
};

struct Extremes {
  std::size_t lowest = 0;
  std::size_t highest = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Extremes extremes_along(const SpacePoints& points, const Eigen::Vector3d& normal) {
  Extremes found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = normal.dot(points[i]);
    if (height < found.low) {
      found.low = height;
      found.lowest = i;
    }
    if (height > found.high) {
      found.high = height;
      found.highest = i;
    }
  }
  return found;
}

/// Thinnest slab about a few points, by trying every normal that contacts can fix: a plane through
/// three, or parallel to two lines through two each.
class SlabOfFew {
 public:
  SlabOfFew(const SpacePoints& points, const std::vector<std::size_t>& indices) {
    for (const std::size_t index : indices) {
      points_.push_back(points[index]);
    }
  }

  void solve() {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = i; k < n; ++k) {
          for (std::size_t l = k + 1; l < n; ++l) {
            if (k > i || l > j) {
              consider((points_[j] - points_[i]).cross(points_[l] - points_[k]));
            }
          }
        }
      }
    }
  }

  double width() const { return width_; }
  const Eigen::Vector3d& normal() const { return normal_; }

 private:
  /// Takes the direction if it beats the best so far; gives up at the first point that says it
  /// cannot.
  void consider(const Eigen::Vector3d& direction) {
    const double length = direction.norm();
    if (!(length > 0)) {
      return;
    }
    const Eigen::Vector3d normal = direction / length;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& point : points_) {
      const double height = normal.dot(point);
      low = std::min(low, height);
      high = std::max(high, height);
      if (high - low >= width_) {
        return;
      }
    }
    width_ = high - low;
    normal_ = normal;
  }

  SpacePoints points_;
  double width_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
};

/// Points that stick out in directions all round.
std::vector<std::size_t> outer_points(const Surface& surface) {
  std::vector<std::size_t> found;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (const double z : {0.0, 1.0}) {
        // Flat surfaces: directions near the normal tell more than directions all round.
        const Eigen::Vector3d direction = surface.axes * Eigen::Vector3d(z, 0.1 * x, 0.1 * y);
        const Extremes ends = extremes_along(surface.points, direction);
        add_missing({ends.lowest, ends.highest}, &found);
      }
    }
  }
  return found;
}

Flatness about_plane(const Surface& surface, const Eigen::Vector3d& normal) {
  const Extremes ends = extremes_along(surface.points, normal);
  return {surface.mean, normal, ends.low, ends.high, {ends.lowest, ends.highest}};
}

}  // namespace

Flatness least_squares_flatness(const SpacePoints& points) {
  const Surface surface(points);
  return about_plane(surface, surface.axes.col(0));
}

Flatness minimum_zone_flatness(const SpacePoints& points) {
  const Surface surface(points);
  std::vector<std::size_t> few = outer_points(surface);
  for (;;) {
    SlabOfFew slab(surface.points, few);
    slab.solve();
    Flatness plane = about_plane(surface, slab.normal());
    if (plane.value() <= slab.width() || !add_missing(plane.support, &few)) {
      const double contact = 1e-12 * (plane.normal.cwiseAbs().sum() * plane.value()) + 1e-15;
      plane.support.clear();
      for (const std::size_t index : few) {
        const double height = plane.normal.dot(surface.points[index]);
        if (height <= plane.low + contact || height >= plane.high - contact) {
          plane.support.push_back(index);
        }
      }
      return plane;
    }
  }
}

}  // namespace flexcomp::geometry
