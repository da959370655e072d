#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Where a residual concentrates. Everything in it is significant at 1 %, the places looked at
/// counted (Bonferroni).
struct Location {
  std::vector<int> joints;
  std::vector<std::string> axes;                ///< x, y, z of the base
  std::vector<std::pair<double, double>> time;  ///< s, stretches of the first recording
  std::vector<double> frequency_hz;
  /// In the machine's own terms, the strongest first, with the share of the residual's power that
  /// goes with it: load, speed, direction, reversals and angle of a joint, temperature, path angle.
  std::vector<std::pair<std::string, double>> correlates_with;
};

/// Locates a residual (over the noise, all samples).
Location locate(const Observations& observations, const Eigen::VectorXd& residual);

}  // namespace flexcomp::diagnosis
