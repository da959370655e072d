#include "recording/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flexcomp::recording {
namespace {

double median(std::vector<double>* values) {
  if (values->empty()) {
    return 0;
  }
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

double robust_deviation(const Eigen::VectorXd& values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::isfinite(value)) {
      sizes.push_back(std::abs(value));
    }
  }
  return 1.4826 * median(&sizes);
}

double white_noise(const Eigen::VectorXd& signal, Eigen::Index stride) {
  constexpr Eigen::Index kFewest = 12;
  const Eigen::Index n = signal.size() - 3 * stride;
  if (n < kFewest - 3) {
    return robust_deviation(signal);
  }
  return robust_deviation(signal.tail(n) - 3 * signal.segment(2 * stride, n) +
                          3 * signal.segment(stride, n) - signal.head(n)) /
         std::sqrt(20.0);
}

double encoder_noise(const Eigen::VectorXd& time, const Eigen::VectorXd& angle) {
  constexpr Eigen::Index kSide = 3;
  if (angle.size() <= 2 * kSide) {
    return 0;
  }
  Eigen::VectorXd misses(angle.size() - 2 * kSide);
  for (Eigen::Index row = kSide; row + kSide < angle.size(); ++row) {
    double predicted = 0;
    double squares = 1;
    for (Eigen::Index i = row - kSide; i <= row + kSide; ++i) {
      double weight = i == row ? 0 : 1;  // Lagrange's
      for (Eigen::Index other = row - kSide; other <= row + kSide && i != row; ++other) {
        if (other != i && other != row) {
          weight *= (time[row] - time[other]) / (time[i] - time[other]);
        }
      }
      predicted += weight * (angle[i] - angle[row]);
      squares += weight * weight;
    }
    misses[row - kSide] = predicted / std::sqrt(squares);
  }
  return robust_deviation(misses);
}

bool stands_alone(const Eigen::VectorXd& signal, Eigen::Index row, double noise) {
  constexpr double kFar = 8;
  constexpr Eigen::Index kReach = 3;
  std::vector<double> near;
  for (Eigen::Index i = std::max<Eigen::Index>(row - kReach, 0);
       i <= std::min(row + kReach, signal.size() - 1); ++i) {
    if (i != row && std::isfinite(signal[i])) {
      near.push_back(signal[i]);
    }
  }
  if (near.size() < 4) {
    return false;
  }
  const double middle = median(&near);
  for (double& value : near) {
    value = std::abs(value - middle);
  }
  return std::abs(signal[row] - middle) > kFar * std::max(noise, 1.4826 * median(&near));
}

double effective_samples(double count, double correlation) {
  const double bounded = std::clamp(correlation, 0.0, 0.99);
  return std::max(count * (1 - bounded) / (1 + bounded), 3.0);
}

}  // namespace flexcomp::recording
