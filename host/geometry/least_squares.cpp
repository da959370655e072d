#include <Eigen/Cholesky>
#include <cmath>

#include "geometry/profile.hpp"

namespace flexcomp::geometry {
namespace {

/// Minimiser of Σ(|p|² − 2 c·p − k)², linear in the centre c: close to the least-squares centre for
/// a full circle, and a fair start for an arc (Kåsa 1976).
Eigen::Vector2d algebraic_center(const Profile& profile) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& point : profile.points()) {
    const Eigen::Vector2d p = point / profile.extent();
    const Eigen::Vector3d row(2 * p.x(), 2 * p.y(), 1);
    normal += row * row.transpose();
    right += row * p.squaredNorm();
  }
  const Eigen::Vector3d solution = normal.ldlt().solve(right);
  return profile.extent() * solution.head<2>();
}

/// Sum of squares, its gradient and its Hessian at a centre, the radius being the mean distance.
struct Objective {
  double value = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();

  Objective(const Profile& profile, const Eigen::Vector2d& center) {
    const auto count = static_cast<double>(profile.size());
    double radius = 0;
    for (const Eigen::Vector2d& point : profile.points()) {
      radius += (point - center).norm();
    }
    radius /= count;
    Eigen::Vector2d directions = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& point : profile.points()) {
      const Eigen::Vector2d arm = point - center;
      const double distance = arm.norm();
      const double error = distance - radius;
      value += error * error;
      if (distance > 0) {
        const Eigen::Vector2d direction = arm / distance;
        directions += direction;
        gradient -= 2 * error * direction;
        const Eigen::Matrix2d along = direction * direction.transpose();
        hessian += 2 * (along + error / distance * (Eigen::Matrix2d::Identity() - along));
      }
    }
    hessian -= 2 / count * directions * directions.transpose();
  }
};

}  // namespace

Eigen::Vector2d least_squares_center(const Profile& profile) {
  constexpr int kMaxSteps = 200;
  Eigen::Vector2d center = algebraic_center(profile);
  Objective at(profile, center);
  double damping = 0;
  const double rounding = 1e-15 * profile.extent() * std::sqrt(static_cast<double>(profile.size()));
  for (int step = 0; step < kMaxSteps; ++step) {
    const double scale = at.hessian.trace();
    const Eigen::LLT<Eigen::Matrix2d> solver(at.hessian +
                                             damping * scale * Eigen::Matrix2d::Identity());
    if (solver.info() != Eigen::Success) {
      damping = damping > 0 ? 4 * damping : 1e-3;
      continue;
    }
    const Eigen::Vector2d move = -solver.solve(at.gradient);
    const Objective next(profile, center + move);
    // Near the optimum the sums differ by rounding alone, of distances as large as the extent;
    // Newton's step is then to be trusted.
    const bool better = next.value <= at.value + rounding * std::sqrt(at.value);
    if (!better) {
      damping = damping > 0 ? 4 * damping : 1e-3;
      continue;
    }
    center += move;
    at = next;
    damping = damping > 1e-12 ? damping / 8 : 0;
    if (damping == 0 && move.norm() <= 1e-15 * profile.extent()) {
      break;
    }
  }
  return center;
}

Circularity least_squares_circularity(const Points& points) {
  const Profile profile(points);
  const Eigen::Vector2d center = least_squares_center(profile);
  const Profile::Range range = profile.range(center);
  return profile.about(center, {range.nearest}, {range.farthest});
}

}  // namespace flexcomp::geometry
