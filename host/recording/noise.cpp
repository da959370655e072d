#include "recording/noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "statistics/median.hpp"

namespace flexcomp::recording {
namespace {

/// The values that are there; how many rows they lie apart, typically.
Eigen::Index take_known(const Eigen::VectorXd& signal, Eigen::VectorXd* known) {
  std::vector<double> steps;
  Eigen::Index count = 0;
  Eigen::Index last = -1;
  known->resize(signal.size());
  for (Eigen::Index row = 0; row < signal.size(); ++row) {
    if (std::isfinite(signal[row])) {
      (*known)[count++] = signal[row];
      if (last >= 0) {
        steps.push_back(static_cast<double>(row - last));
      }
      last = row;
    }
  }
  known->conservativeResize(count);
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(statistics::median(std::move(steps))));
}

/// Values nearest before (step −1) or after (step 1) a row, so many at most.
void add_neighbours(const Eigen::VectorXd& signal, Eigen::Index row, Eigen::Index step,
                    std::size_t most, std::vector<double>* near) {
  const std::size_t wanted = near->size() + most;
  for (Eigen::Index i = row + step; i >= 0 && i < signal.size() && near->size() < wanted;
       i += step) {
    if (std::isfinite(signal[i])) {
      near->push_back(signal[i]);
    }
  }
}

}  // namespace

double robust_deviation(const Eigen::VectorXd& values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::isfinite(value)) {
      sizes.push_back(std::abs(value));
    }
  }
  return 1.4826 * statistics::median(std::move(sizes));
}

double white_noise(const Eigen::VectorXd& signal, Eigen::Index stride) {
  constexpr Eigen::Index kFewest = 12;  // samples, chosen by judgement: nine differences
  Eigen::VectorXd known;
  const Eigen::Index step = std::max<Eigen::Index>(1, stride / take_known(signal, &known));
  const Eigen::Index n = known.size() - 3 * step;
  if (n < kFewest - 3) {
    return robust_deviation(known);
  }
  return robust_deviation(known.tail(n) - 3 * known.segment(2 * step, n) +
                          3 * known.segment(step, n) - known.head(n)) /
         std::sqrt(20.0);
}

double quantisation_step(const Eigen::VectorXd& signal) {
  constexpr double kWhole = 0.1;    // of a step: how far a multiple may be from a whole one
  constexpr double kMostly = 0.95;  // of the steps between neighbours, that are multiples
  constexpr double kOnce = 0.9;     // of the values: hardly one comes twice
  std::vector<double> sizes;
  std::vector<double> values;
  for (Eigen::Index row = 1; row < signal.size(); ++row) {
    const double size = std::abs(signal[row] - signal[row - 1]);
    if (std::isfinite(size)) {
      values.push_back(signal[row]);
      if (size > 1e-12) {
        sizes.push_back(size);
      }
    }
  }
  std::sort(values.begin(), values.end());
  const auto distinct = std::unique(values.begin(), values.end()) - values.begin();
  if (sizes.empty() || static_cast<double>(distinct) > kOnce * static_cast<double>(values.size())) {
    return 0;
  }
  const double step = *std::min_element(sizes.begin(), sizes.end());
  const auto whole = std::count_if(sizes.begin(), sizes.end(), [step](double size) {
    return std::abs(size / step - std::round(size / step)) < kWhole;
  });
  return static_cast<double>(whole) > kMostly * static_cast<double>(sizes.size()) ? step : 0;
}

Eigen::VectorXd neighbour_misses(const Eigen::VectorXd& time, const Eigen::VectorXd& angle) {
  constexpr Eigen::Index kSide = 3;  // neighbours: six numbers of a polynomial of fifth order
  if (angle.size() <= 2 * kSide) {
    return {};
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
  return misses;
}

double encoder_noise(const Eigen::VectorXd& time, const Eigen::VectorXd& angle) {
  const Eigen::VectorXd misses = neighbour_misses(time, angle);
  if (misses.size() == 0) {
    return 0;
  }
  // The error of rounding is spread evenly over a step.
  return std::max(robust_deviation(misses), quantisation_step(angle) / std::sqrt(12.0));
}

bool stands_alone(const Eigen::VectorXd& signal, Eigen::Index row, double noise) {
  constexpr double kFar = 8;         // deviations, chosen by judgement: no noise gets there
  constexpr std::size_t kReach = 3;  // neighbours on either side, which a motion is nearly straight
                                     // over
  std::vector<double> near;
  add_neighbours(signal, row, -1, kReach, &near);
  add_neighbours(signal, row, 1, kReach, &near);
  if (near.size() < 4) {
    return false;
  }
  const double middle = statistics::median(near);
  for (double& value : near) {
    value = std::abs(value - middle);
  }
  return std::abs(signal[row] - middle) >
         kFar * std::max(noise, 1.4826 * statistics::median(std::move(near)));
}

double effective_samples(double count, double correlation) {
  const double bounded = std::clamp(correlation, 0.0, 0.99);
  return std::max(count * (1 - bounded) / (1 + bounded), 3.0);
}

}  // namespace flexcomp::recording
