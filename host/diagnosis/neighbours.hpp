#pragma once

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Likeness of a load test's remainders (all samples, over the noise) at neighbouring poses, in
/// standard deviations from that by chance: Moran's I (Moran 1950; Cliff and
/// Ord 1981) over each pose's nearest neighbours, in angles and wrench over their spread, against
/// the same values dealt to the poses at random. Noise knows nothing of the pose; what a model has
/// left out does. Zero where there are too few poses to tell.
double likeness_of_neighbours(const Observations& observations, const Eigen::VectorXd& remainder);

}  // namespace flexcomp::diagnosis
