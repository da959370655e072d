#pragma once

#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Samples to fit to, divided into clusters: errors may hang together within one, and not between
/// two.
struct Clusters {
  std::vector<Eigen::Index> of;  ///< the cluster of each sample, from zero
  Eigen::Index count = 0;
};

/// By time: the stretches of each scene. They hold what drifts, or comes late.
Clusters clusters_in_time(const Observations& observations);

/// By the state of the motion, of all scenes together: rows whose angles and speeds lie near each
/// other, in cells of equally many rows. They hold what the model lacks at a posture: it is the
/// same in each round of a motion that repeats, so that rounds are not independent of each other.
Clusters clusters_in_state(const Observations& observations);

}  // namespace flexcomp::diagnosis
