#pragma once

#include <string>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Why what a fit leaves (all samples, over the noise) is not nothing but noise, in words; empty
/// where it is.
///
/// A motion's noise is known from its samples: what is larger is more than noise. In a load test
/// only a fit can tell the noise, so that what it leaves is as large as that: there it must not be
/// alike at neighbouring poses either.
std::string more_than_noise(const Observations& observations, const Eigen::VectorXd& remainder);

}  // namespace flexcomp::diagnosis
