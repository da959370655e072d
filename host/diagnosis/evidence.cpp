#include "diagnosis/evidence.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "recording/noise.hpp"

namespace flexcomp::diagnosis {
namespace {

bool are_neighbours(const Sample& a, const Sample& b) {
  return a.scene == b.scene && a.channel == b.channel && a.component == b.component &&
         b.row - a.row <= 2;
}

/// Deviations by which the squares that were held out fall, block by block of time: what varies is
/// the product of the change with what is left.
double confirmation_of(const Observations& observations, const Eigen::VectorXd& before,
                       const Eigen::VectorXd& after) {
  constexpr Eigen::Index kBlock = 25;  // rows
  double fall = 0;
  std::map<std::tuple<std::size_t, int, Eigen::Index, Eigen::Index>, double> products;
  for (Eigen::Index i = observations.train; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    // A sample that is far off either way shall not decide.
    const double limit = 6;
    const double b = std::clamp(before[i], after[i] - limit, after[i] + limit);
    const double a = std::clamp(after[i], -limit, limit);
    fall += b * b - a * a;
    products[{at.scene, at.channel, at.component, at.row / kBlock}] += a * (b - a);
  }
  double variance = 0;
  for (const auto& [block, product] : products) {
    variance += 4 * product * product;
  }
  return variance > 0 ? fall / std::sqrt(variance) : 0;
}

double strength_of(const Observations& observations, const Eigen::VectorXd& change) {
  std::map<std::tuple<std::size_t, int, Eigen::Index>, std::pair<double, double>> sums;
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    auto& [sum, count] = sums[{at.scene, at.channel, at.component}];
    sum += change[i] * change[i];
    count += 1;
  }
  double most = 0;
  for (const auto& [component, sum] : sums) {
    most = std::max(most, std::sqrt(sum.first / sum.second));
  }
  return most;
}

/// Part of the fall of the squares in the component where it is largest that was beyond the noise.
double beyond_noise(const Observations& observations, const Eigen::VectorXd& before,
                    const Eigen::VectorXd& after) {
  struct Sums {
    double before = 0, after = 0, count = 0;
  };
  std::map<std::tuple<std::size_t, int, Eigen::Index>, Sums> sums;
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    Sums& own = sums[{at.scene, at.channel, at.component}];
    own.before += before[i] * before[i];
    own.after += after[i] * after[i];
    own.count += 1;
  }
  double most = 0;
  double part = 0;
  for (const auto& [component, sum] : sums) {
    const double fall = (sum.before - sum.after) / sum.count;
    if (fall > most) {
      most = fall;
      part = (sum.before / sum.count - 1) / fall;
    }
  }
  return part;
}

}  // namespace

double independent_samples(const Observations& observations, const Eigen::VectorXd& remainder) {
  const auto count = static_cast<double>(observations.train);
  if (observations.is_static) {
    return count;
  }
  double product = 0;
  double square = 0;
  for (Eigen::Index i = 1; i < observations.train; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (are_neighbours(observations.samples[at - 1], observations.samples[at])) {
      const double a = std::clamp(remainder[i - 1], -30.0, 30.0);
      const double b = std::clamp(remainder[i], -30.0, 30.0);
      product += a * b;
      square += 0.5 * (a * a + b * b);
    }
  }
  return recording::effective_samples(count, square > 0 ? product / square : 0);
}

double bic_gain(double samples, double sum_before, double sum_after, std::size_t parameters) {
  constexpr double kTiny = 1e-300;
  return samples * std::log(std::max(sum_before, kTiny) / std::max(sum_after, kTiny)) -
         static_cast<double>(parameters) * std::log(samples);
}

Evidence weigh(const Observations& observations, const Fit& without, const Fit& with,
               double places) {
  Evidence evidence;
  evidence.effective_samples = independent_samples(observations, with.remainder);
  const std::size_t parameters = with.chosen.back().values.size();
  const double ratio = bic_gain(evidence.effective_samples, without.train_sum, with.train_sum, 0);
  evidence.delta_bic =
      bic_gain(evidence.effective_samples, without.train_sum, with.train_sum, parameters);
  if (ratio > 0) {
    const boost::math::chi_squared chance(static_cast<double>(parameters));
    evidence.p_value =
        std::min(1.0, places * boost::math::cdf(boost::math::complement(chance, ratio)));
  }
  const double beyond = without.train_sum - static_cast<double>(observations.train);
  evidence.share = beyond > 0 ? (without.train_sum - with.train_sum) / beyond : 1;
  evidence.confirmation = confirmation_of(observations, without.remainder, with.remainder);
  evidence.strength = strength_of(observations, without.remainder - with.remainder);
  const double whole = strength_of(observations, observations.residual - with.remainder);
  evidence.beyond_noise = beyond_noise(observations, without.remainder, with.remainder);
  evidence.relative_strength = whole > 0 ? evidence.strength / whole : 0;
  return evidence;
}

double largest_ratio(const Observations& observations, const Eigen::VectorXd& remainder) {
  std::array<double, 3> sums{};
  std::array<double, 3> counts{};
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Channel channel = observations.samples[static_cast<std::size_t>(i)].channel;
    const double value = std::clamp(remainder[i], -30.0, 30.0);
    sums[channel] += value * value;
    counts[channel] += 1;
  }
  double most = 0;
  for (std::size_t channel = 0; channel < sums.size(); ++channel) {
    if (counts[channel] > 0) {
      most = std::max(most, std::sqrt(sums[channel] / counts[channel]));
    }
  }
  return most;
}

}  // namespace flexcomp::diagnosis
