#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// A channel of the first recording over time, a panel each for x, y, z or the joints: measured,
/// simulated with the model, and with the updated model; beside it the errors of both (SVG). In a
/// load test over its rows.
std::string course_picture(const Observations& observations, const Eigen::VectorXd& updated,
                           Channel channel);

}  // namespace flexcomp::diagnosis
