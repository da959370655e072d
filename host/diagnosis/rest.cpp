#include "diagnosis/rest.hpp"

#include <fmt/format.h>

#include "diagnosis/evidence.hpp"
#include "diagnosis/neighbours.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Standard deviations: one load test in 700 whose rest is noise is said to have more.
constexpr double kAlike = 3;

}  // namespace

std::string more_than_noise(const Observations& observations, const Eigen::VectorXd& remainder) {
  if (!observations.noise_is_known) {
    return "";
  }
  const double ratio = largest_ratio(observations, remainder);
  if (ratio >= kLikeNoise + 3 * observations.noise_uncertainty) {
    return fmt::format("{:.1f} times the noise is left", ratio);
  }
  return observations.is_static && likeness_of_neighbours(observations, remainder) > kAlike
             ? "what is left is alike at neighbouring poses, as noise is not"
             : "";
}

}  // namespace flexcomp::diagnosis
