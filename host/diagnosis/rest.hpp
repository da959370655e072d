#pragma once

#include <string>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Why the remainder of a fit (all samples, over the noise) is more than noise, in words; empty
/// where it is noise.
///
/// The noise of a motion is known from its samples: a larger remainder is more than noise, and so
/// is one much larger in one component, held out or not. The noise of a load test is known from a
/// fit alone, which leaves as much in any case. A remainder there is more than noise if it is alike
/// at neighbouring poses too.
std::string more_than_noise(const Observations& observations, const Eigen::VectorXd& remainder);

}  // namespace flexcomp::diagnosis
