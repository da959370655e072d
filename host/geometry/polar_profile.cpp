#include "geometry/polar_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "error.hpp"

namespace flexcomp::geometry {

PolarProfile::PolarProfile(const Points& points, const Eigen::Vector2d& center) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> angles;
  angles.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    angles.push_back(std::atan2(point.y() - center.y(), point.x() - center.x()));
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
  for (const std::size_t index : order) {
    angles_.push_back(angles[index]);
    radii_.push_back((points[index] - center).norm());
  }
}

double PolarProfile::radius(double angle) const {
  const double wrapped = angle - 2 * M_PI * std::round(angle / (2 * M_PI));
  const auto above = std::upper_bound(angles_.begin(), angles_.end(), wrapped);
  const auto next = static_cast<std::size_t>(above - angles_.begin()) % angles_.size();
  const std::size_t before = (next + angles_.size() - 1) % angles_.size();
  const auto turned = [](double from, double to) {
    const double by = to - from;
    return by < 0 ? by + 2 * M_PI : by;
  };
  const double width = turned(angles_[before], angles_[next]);
  const double share = width > 0 ? turned(angles_[before], wrapped) / width : 0;
  return radii_[before] + share * (radii_[next] - radii_[before]);
}

Points filtered(const Points& points, double cutoff) {
  if (!(cutoff >= 1 && cutoff <= 10000)) {
    throw InputError("the filter's cut-off must be from 1 to 10000 undulations per revolution");
  }
  const Eigen::Vector2d center = least_squares_circularity(points).center;
  const PolarProfile profile(points, center);
  const auto count = static_cast<std::size_t>(std::max(720.0, std::ceil(32 * cutoff)));
  const double step = 2 * M_PI / static_cast<double>(count);
  std::vector<double> radii(count);
  for (std::size_t i = 0; i < count; ++i) {
    radii[i] = profile.radius(static_cast<double>(i) * step);
  }
  // ISO 16610-21: weight exp(−π (x / (α λ))²) / (α λ), α = √(ln 2 / π), λ the cut-off's wave.
  const double width = std::sqrt(std::log(2) / M_PI) * 2 * M_PI / cutoff;
  const auto reach = std::min(count / 2, static_cast<std::size_t>(std::ceil(2.5 * width / step)));
  std::vector<double> weights(2 * reach + 1);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double x = (static_cast<double>(k) - static_cast<double>(reach)) * step;
    weights[k] = std::exp(-M_PI * std::pow(x / width, 2));
  }
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  Points smooth;
  smooth.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      sum += weights[k] * radii[(i + count + k - reach) % count];
    }
    const double angle = static_cast<double>(i) * step;
    smooth.emplace_back(center + sum / total * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return smooth;
}

}  // namespace flexcomp::geometry
