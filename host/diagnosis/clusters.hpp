#pragma once

#include <array>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// The samples to fit to, divided into clusters. Errors may hang together within a cluster, but not
/// between two.
struct Clusters {
  std::vector<Eigen::Index> of;  ///< the cluster of each sample, from zero
  Eigen::Index count = 0;
};

/// Clusters by time: the stretches of each scene. Errors that drift or come late stay within one.
Clusters clusters_in_time(const Observations& observations);

/// Clusters by the state of the motion, of all scenes together: cells of equally many rows whose
/// angles and speeds lie near each other. An error of the model at a posture stays within one: it
/// is the same in each round of a motion that repeats, so that rounds are not independent.
Clusters clusters_in_state(const Observations& observations);

/// Both: errors hang together in one way or the other.
inline std::array<Clusters, 2> clusters_of_errors(const Observations& observations) {
  return {clusters_in_time(observations), clusters_in_state(observations)};
}

}  // namespace flexcomp::diagnosis
