#include "geometry/nearly_round.hpp"

#include <cmath>

namespace flexcomp::geometry {
namespace {

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
  constexpr double kSettled = 1e-8;
  // Less round than this there may be more than one centre to settle at.
  constexpr double kRound = 0.5;
  const auto count = static_cast<double>(x.size());
  Eigen::ArrayXd u = x;
  Eigen::ArrayXd v = y;
  Eigen::ArrayXd distance = (u.square() + v.square()).sqrt();
  Eigen::ArrayXd lag(x.size());
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const double radius = distance.sum() / count;
    const Eigen::Vector2d arms(u.sum(), v.sum());
    lag = distance.inverse();
    u *= lag;
    v *= lag;
    lag = 1 - radius * lag;
    const Eigen::Vector2d directions(u.sum(), v.sum());
    // Half the gradient and the Hessian of the sum of squares, see least_squares.cpp.
    const Eigen::Vector2d gradient = arms - radius * directions;
    const double uu =
        (u.square() + lag * v.square()).sum() - directions.x() * directions.x() / count;
    const double uv = ((1 - lag) * u * v).sum() - directions.x() * directions.y() / count;
    const double vv =
        (v.square() + lag * u.square()).sum() - directions.y() * directions.y() / count;
    const double determinant = uu * vv - uv * uv;
    if (!(uu > 0 && determinant > 0)) {
      break;
    }
    const Eigen::Vector2d move((vv * gradient.x() - uv * gradient.y()) / determinant,
                               (uu * gradient.y() - uv * gradient.x()) / determinant);
    center += move;
    u = x - center.x();
    v = y - center.y();
    distance = (u.square() + v.square()).sqrt();
    if (move.norm() <= kSettled * radius) {
      const double value = distance.maxCoeff() - distance.minCoeff();
      if (value > kRound * radius) {
        break;
      }
      return value;
    }
  }
  return least_squares_circularity(as_points(x, y)).value();
}

}  // namespace flexcomp::geometry
