#include "geometry/nearly_round.hpp"

#include <cmath>

namespace flexcomp::geometry {
namespace {

/// Sums over the points that Newton's step needs; (a, b) is a point seen from the centre, d its
/// distance.
struct Sums {
  double distance = 0;  ///< d
  double along_x = 0;   ///< a / d
  double along_y = 0;   ///< b / d
  double bend_xx = 0;   ///< a² / d³
  double bend_xy = 0;   ///< a b / d³
  double bend_yy = 0;   ///< b² / d³

  Sums(const Eigen::Ref<const Eigen::ArrayXd>& x, const Eigen::Ref<const Eigen::ArrayXd>& y,
       const Eigen::Vector2d& center) {
    constexpr Eigen::Index kWidth = 4;
    using Lanes = Eigen::Array<double, kWidth, 1>;
    const Eigen::Index whole = x.size() / kWidth * kWidth;
    Lanes sums[6];
    for (Lanes& sum : sums) {
      sum.setZero();
    }
    for (Eigen::Index i = 0; i < whole; i += kWidth) {
      const Lanes a = x.segment<kWidth>(i) - center.x();
      const Lanes b = y.segment<kWidth>(i) - center.y();
      const Lanes d = (a * a + b * b).sqrt();
      const Lanes inverse = d.inverse();
      const Lanes u = a * inverse;
      const Lanes v = b * inverse;
      sums[0] += d;
      sums[1] += u;
      sums[2] += v;
      const Lanes bent = u * inverse;
      sums[3] += u * bent;
      sums[4] += v * bent;
      sums[5] += v * v * inverse;
    }
    distance = sums[0].sum();
    along_x = sums[1].sum();
    along_y = sums[2].sum();
    bend_xx = sums[3].sum();
    bend_xy = sums[4].sum();
    bend_yy = sums[5].sum();
    for (Eigen::Index i = whole; i < x.size(); ++i) {
      const double a = x[i] - center.x();
      const double b = y[i] - center.y();
      const double d = std::sqrt(a * a + b * b);
      distance += d;
      along_x += a / d;
      along_y += b / d;
      bend_xx += a * a / (d * d * d);
      bend_xy += a * b / (d * d * d);
      bend_yy += b * b / (d * d * d);
    }
  }
};

Points as_points(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y) {
  Points points(static_cast<std::size_t>(x.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    points[static_cast<std::size_t>(i)] = {x[i], y[i]};
  }
  return points;
}

}  // namespace

double nearly_round_circularity(const Eigen::Ref<const Eigen::ArrayXd>& x,
                                const Eigen::Ref<const Eigen::ArrayXd>& y) {
  constexpr int kMostSteps = 6;
  // Newton's steps square what is left: after one of this share of the radius nothing is.
  constexpr double kSettled = 1e-6;
  // Less round than this there may be more than one centre to settle at.
  constexpr double kRound = 0.5;
  const auto count = static_cast<double>(x.size());
  const Eigen::Vector2d mean(x.mean(), y.mean());
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const Sums sums(x, y, center);
    const double radius = sums.distance / count;
    // Half the gradient and the Hessian of the sum of squares, see least_squares.cpp; unit vectors
    // have u² = 1 − v².
    const Eigen::Vector2d gradient =
        count * (mean - center) - radius * Eigen::Vector2d(sums.along_x, sums.along_y);
    const double uu = count - radius * sums.bend_yy - sums.along_x * sums.along_x / count;
    const double uv = radius * sums.bend_xy - sums.along_x * sums.along_y / count;
    const double vv = count - radius * sums.bend_xx - sums.along_y * sums.along_y / count;
    const double determinant = uu * vv - uv * uv;
    if (!(uu > 0 && determinant > 0)) {
      break;
    }
    const Eigen::Vector2d move((vv * gradient.x() - uv * gradient.y()) / determinant,
                               (uu * gradient.y() - uv * gradient.x()) / determinant);
    center += move;
    if (move.norm() <= kSettled * radius) {
      const auto squared = (x - center.x()).square() + (y - center.y()).square();
      const double value = std::sqrt(squared.maxCoeff()) - std::sqrt(squared.minCoeff());
      if (value > kRound * radius) {
        break;
      }
      return value;
    }
  }
  return least_squares_circularity(as_points(x, y)).value();
}

}  // namespace flexcomp::geometry
