#include "diagnosis/rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "diagnosis/evidence.hpp"
#include "diagnosis/neighbours.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Standard deviations: one load test in 700 whose rest is noise is said to have more.
constexpr double kAlike = 3;

/// Times its noise, left in one joint's torque or deflection or along one axis. What is known of
/// one component's noise is known to some tenths; beyond this the mean of all hides a mismatch.
constexpr double kMostInOne = 1.7;

struct Component {
  Channel channel;
  Eigen::Index index;
  double ratio = 0;  ///< of what is left to its noise
};

/// The component of which the most is left, in what was fitted to or in what was held out.
Component largest_component(const Observations& observations, const Eigen::VectorXd& remainder) {
  std::map<std::tuple<Channel, Eigen::Index, bool>, std::pair<double, double>> sums;
  for (Eigen::Index i = 0; i < observations.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const double value = std::clamp(observations.over_floor(i, remainder[i]), -kGross, kGross);
    auto& [squares, count] = sums[{at.channel, at.component, i >= observations.train}];
    squares += value * value;
    count += 1;
  }
  Component most{};
  for (const auto& [part, sum] : sums) {
    const double ratio = std::sqrt(sum.first / sum.second);
    if (ratio > most.ratio) {
      most = {std::get<Channel>(part), std::get<Eigen::Index>(part), ratio};
    }
  }
  return most;
}

}  // namespace

std::string more_than_noise(const Observations& observations, const Eigen::VectorXd& remainder) {
  if (!observations.noise_is_known) {
    return "";
  }
  const double ratio = largest_ratio(observations, remainder);
  if (ratio >= kLikeNoise + 3 * observations.noise_uncertainty) {
    return fmt::format("{:.1f} times the noise is left", ratio);
  }
  if (observations.is_static) {
    return likeness_of_neighbours(observations, remainder) > kAlike
               ? "what is left is alike at neighbouring poses, as noise is not"
               : "";
  }
  const Component most = largest_component(observations, remainder);
  if (most.ratio < kMostInOne) {
    return "";
  }
  return fmt::format("{:.1f} times the noise is left {}", most.ratio,
                     most.channel == simulation::tcp_position
                         ? fmt::format("along {}", "xyz"[most.index])
                         : fmt::format("at joint {}", most.index + 1));
}

}  // namespace flexcomp::diagnosis
