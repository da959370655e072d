#include "diagnosis/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "diagnosis/covariance.hpp"
#include "diagnosis/jump.hpp"
#include "diagnosis/plausible.hpp"
#include "recording/noise.hpp"
#include "statistics/distributions.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Times the noise: a fit that comes so near claims to be right. Chosen by judgement, as is the
/// next.
constexpr double kAsGoodAsNoise = 2;
/// Times its error where it was fitted: such a fit must not be so much worse elsewhere.
constexpr double kFarWorse = 1.5;

/// Sums of squares over samples, weighted so that single samples that are far off after the fit do
/// not decide.
struct Squares {
  double first = 0;              ///< of the mismatch
  double before = 0, after = 0;  ///< of the remainder, without and with the hypothesis
  double change = 0, whole = 0;  ///< of what the hypothesis, and of what the whole fit changes
  double count = 0;
  Group group;
};

/// Sums of each component of a channel in a scene, or of each group (the TCP's position, a joint's
/// torque, a joint's deflection) in all of them.
std::vector<Squares> squares_of(const Observations& observations, const Fit& without,
                                const Fit& with, bool by_group) {
  const auto n = static_cast<double>(std::max<Eigen::Index>(observations.train, 1));
  const double spread = std::max(1.0, std::sqrt(with.train_sum / n));
  std::map<std::tuple<std::size_t, int, Eigen::Index>, Squares> all;
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const bool is_whole = by_group && at.channel == simulation::tcp_position;
    Squares& own = all[{by_group ? 0 : at.scene, at.channel, is_whole ? 0 : at.component}];
    const double first = observations.residual[i];
    const double before = without.remainder[i];
    const double after = with.remainder[i];
    const double weight = std::min(1.0, kFarOff * spread / std::max(std::abs(after), 1e-12));
    own.first += weight * first * first;
    own.before += weight * before * before;
    own.after += weight * after * after;
    own.change += weight * (before - after) * (before - after);
    own.whole += weight * (first - after) * (first - after);
    own.count += weight;
    own.group = {at.channel, is_whole ? 0 : at.component};
  }
  std::vector<Squares> list;
  list.reserve(all.size());
  for (const auto& [place, squares] : all) {
    list.push_back(squares);
  }
  return list;
}

}  // namespace

bool are_of_one_place(const Group& a, const Group& b) {
  const bool is_joint = a.first != simulation::tcp_position && b.first != simulation::tcp_position;
  return a == b || (is_joint && a.second == b.second);
}

// Block by block of time, or row by row of a load test: the product of the change with the
// remainder is what varies.
double confirmation_of(const Observations& observations, const Eigen::VectorXd& before,
                       const Eigen::VectorXd& after) {
  constexpr Eigen::Index kMemory = 25;  // rows, over which remainders of a motion hang together
  const Eigen::Index block_size = observations.is_static ? 1 : kMemory;
  const Eigen::Index held_out = observations.size() - observations.train;
  const double limit = kFarOff * std::max(1.0, recording::robust_deviation(after.tail(held_out)));
  double fall = 0;
  std::map<std::tuple<std::size_t, int, Eigen::Index, Eigen::Index>, double> products;
  for (Eigen::Index i = observations.train; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const double a = std::clamp(after[i], -limit, limit);
    const double b = a + std::clamp(before[i] - after[i], -limit, limit);
    fall += b * b - a * a;
    products[{at.scene, at.channel, at.component, at.row / block_size}] += a * (b - a);
  }
  double variance = 0;
  for (const auto& [block, product] : products) {
    variance += 4 * product * product;
  }
  return variance > 0 ? fall / std::sqrt(variance) : 0;
}

double independent_samples(const Observations& observations, const Eigen::VectorXd& remainder) {
  const Eigen::VectorXd left =
      remainder.head(observations.train).cwiseMax(-kGross).cwiseMin(kGross);
  return static_cast<double>(observations.train) / correlated_widening(observations, left);
}

double bic_gain(double samples, double sum_before, double sum_after, std::size_t parameters) {
  constexpr double kTiny = 1e-300;  // zero has no logarithm
  const double fall = std::log(std::max(sum_before, kTiny)) - std::log(std::max(sum_after, kTiny));
  return samples * fall - static_cast<double>(parameters) * std::log(samples);
}

double bic_gain(const Observations& observations, const Fit& plain, const Fit& rich) {
  const double samples = independent_samples(observations, rich.remainder);
  return bic_gain(samples, plain.train_sum, rich.train_sum, 0) -
         (rich.told - plain.told) * std::log(samples);
}

Evidence weigh(const Observations& observations, const Fit& without, const Fit& with,
               double places) {
  Evidence evidence;
  evidence.impossible = why_impossible(observations, with, with.chosen.size() - 1);
  if (evidence.impossible.empty() && jumps_instead(observations, without, with)) {
    evidence.impossible = "a jump at one moment accounts for more";
  }
  evidence.effective_samples = independent_samples(observations, with.remainder);
  const std::size_t parameters = with.parameters() - without.parameters();
  const double ratio = bic_gain(evidence.effective_samples, without.train_sum, with.train_sum, 0);
  evidence.delta_bic =
      bic_gain(evidence.effective_samples, without.train_sum, with.train_sum, parameters);
  if (ratio > 0) {
    evidence.p_value = std::min(
        1.0, places * statistics::chi_squared_above(ratio, static_cast<double>(parameters)));
  }
  evidence.confirmation = confirmation_of(observations, without.remainder, with.remainder);
  for (const Channel channel : observations.channels()) {
    evidence.lowers_held_out =
        evidence.lowers_held_out || observations.rms(with.remainder, channel, true) <
                                        observations.rms(without.remainder, channel, true);
  }
  constexpr double kTiny = 1e-9;  // squares: against a division by zero
  for (const Squares& each : squares_of(observations, without, with, false)) {
    evidence.strength = std::max(evidence.strength, std::sqrt(each.change / each.count));
  }
  double most = 0;
  for (const Squares& each : squares_of(observations, without, with, true)) {
    if (each.change > each.count) {
      evidence.shows.push_back(each.group);
    }
    // By noise alone the component that is measured best decides, whatever else is wrong there.
    const double clear = each.change / std::max(each.count, each.after);
    if (clear > most) {
      most = clear;
      const double fall = each.before - each.after;
      evidence.group = each.group;
      evidence.relative_strength = std::sqrt(each.change / std::max(each.whole, kTiny));
      const double noise = std::min(each.count, each.after);
      evidence.share = fall / std::max(each.before - noise, kTiny);
      evidence.beyond_noise = (each.before - each.count) / std::max(fall, kTiny);
      evidence.explained = 1 - (each.after - each.count) / std::max(each.first - each.count, kTiny);
      evidence.left = std::sqrt(each.after / each.count);
    }
  }
  if (evidence.shows.empty()) {
    evidence.shows = {evidence.group};
  }
  return evidence;
}

bool fails_held_out(const Observations& observations, const Eigen::VectorXd& remainder,
                    const Group& group) {
  if (observations.is_static) {
    return false;
  }
  struct Sum {
    double sum = 0, count = 0;
    double ratio() const { return std::sqrt(sum / std::max(count, 1.0)); }
  };
  std::map<Eigen::Index, std::array<Sum, 2>> components;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.channel != group.first ||
        (at.channel != simulation::tcp_position && at.component != group.second)) {
      continue;
    }
    Sum& part = components[at.component][i < observations.train ? 0 : 1];
    const double value = std::clamp(remainder[i], -kGross, kGross);
    part.sum += value * value;
    part.count += 1;
  }
  return std::any_of(components.begin(), components.end(), [](const auto& component) {
    const double fitted = component.second[0].ratio();
    const double held_out = component.second[1].ratio();
    return fitted < kAsGoodAsNoise && held_out > kFarWorse * std::max(fitted, 1.0);
  });
}

double largest_ratio(const Observations& observations, const Eigen::VectorXd& remainder) {
  std::array<double, 3> sums{};
  std::array<double, 3> counts{};
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Channel channel = observations.samples[static_cast<std::size_t>(i)].channel;
    const double value = std::clamp(observations.over_floor(i, remainder[i]), -kGross, kGross);
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

bool predicts_better(const Observations& observations, const Fit& before, const Fit& after) {
  constexpr double kNoticeable = 0.99;  // of the error: nobody would change a model for less
  constexpr double kRounding = 1e-9;
  double best = 1;
  double worst = 0;
  for (const Channel channel : observations.channels()) {
    const double ratio = observations.rms(after.remainder, channel, true) /
                         observations.rms(before.remainder, channel, true);
    best = std::min(best, ratio);
    worst = std::max(worst, ratio);
  }
  return best < kNoticeable && worst <= 1 + kRounding;
}

}  // namespace flexcomp::diagnosis
