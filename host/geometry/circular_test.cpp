#include "geometry/circular_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "error.hpp"
#include "geometry/polar_profile.hpp"

namespace flexcomp::geometry {
namespace {

/// Least and largest distance from a centre, less the nominal radius.
std::pair<double, double> radial_deviations(const Points& points, const Eigen::Vector2d& center,
                                            double radius) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Eigen::Vector2d& point : points) {
    const double deviation = (point - center).norm() - radius;
    least = std::min(least, deviation);
    most = std::max(most, deviation);
  }
  return {least, most};
}

}  // namespace

CircularTest circular_test(const Points& clockwise, const Points& counterclockwise, double radius) {
  if (!(radius > 0)) {
    throw InputError("the nominal radius must be above zero");
  }
  Points both = clockwise;
  both.insert(both.end(), counterclockwise.begin(), counterclockwise.end());
  CircularTest test;
  test.clockwise = minimum_zone_circularity(clockwise).value();
  test.counterclockwise = minimum_zone_circularity(counterclockwise).value();
  test.bidirectional = minimum_zone_circularity(both).value();

  const Eigen::Vector2d center = least_squares_circularity(both).center;
  std::tie(test.clockwise_least, test.clockwise_most) =
      radial_deviations(clockwise, center, radius);
  std::tie(test.counterclockwise_least, test.counterclockwise_most) =
      radial_deviations(counterclockwise, center, radius);

  const PolarProfile one(clockwise, center);
  const PolarProfile other(counterclockwise, center);
  constexpr int kAngles = 3600;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * M_PI * i / kAngles;
    const double a = one.radius(angle);
    const double b = other.radius(angle);
    test.hysteresis = std::max(test.hysteresis, std::abs(a - b));
    sum += (a + b) / 2;
  }
  test.mean_radial = sum / kAngles - radius;
  return test;
}

}  // namespace flexcomp::geometry
