#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/parameters.hpp"

namespace flexcomp::diagnosis {

/// Size of the residual along the time of the first recording, before and after (SVG).
std::string time_picture(const Observations& observations, const Eigen::VectorXd& after,
                         Channel channel);

/// Root mean square of the TCP's residual along the path angle of the first recording (SVG).
std::string path_picture(const Observations& observations, const Eigen::VectorXd& after);

/// The share that each effect would explain alone, as bars (SVG); empty without any.
std::string ranking_picture(const std::vector<Ranked>& ranking);

}  // namespace flexcomp::diagnosis
