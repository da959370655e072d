#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// A quantity with which a residual correlates.
struct Correlate {
  std::string cue;     ///< "load on joint 2", "direction of motion of joint 3", "path angle", …
  int joint = 0;       ///< 0 where it belongs to none
  double share = 0;    ///< of the residual's power in the samples to fit to
  double p_value = 1;  ///< by chance, times all places looked at
};

/// Where a residual concentrates. Everything named is significant at 1 %, with the number of places
/// that were looked at counted (Bonferroni).
struct Location {
  std::vector<int> joints;
  std::vector<std::string> axes;                ///< x, y, z of the base
  std::vector<std::pair<double, double>> time;  ///< s, stretches of the first recording
  std::vector<double> frequency_hz;
  std::vector<Correlate> correlates_with;  ///< the strongest first
  std::size_t places = 0;                  ///< looked at
};

/// Locates a residual (over the noise, all samples). A joint's residual is what an error of its
/// angle or torque would explain; it is averaged over classes of a cue, and the power of the means
/// is tested (analysis of variance, with the count of independent samples).
Location locate(const Observations& observations, const Eigen::VectorXd& residual);

}  // namespace flexcomp::diagnosis
