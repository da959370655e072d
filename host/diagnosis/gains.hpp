#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Factors by which chosen gains multiply the torques of each joint; one where none does.
Eigen::VectorXd gains_of(const std::vector<Chosen>& chosen, int joints);

/// Each sample's own of such factors of the joints' torques; one for what is no torque. Of the
/// first `count` samples.
Eigen::VectorXd by_sample(const Observations& observations, const Eigen::VectorXd& factors,
                          Eigen::Index count);

}  // namespace flexcomp::diagnosis
