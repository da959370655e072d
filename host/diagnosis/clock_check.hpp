#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Delay of a group of columns against the joint angles.
struct ClockCheck {
  std::string group;     ///< tcp_position, joint_torque, joint_deflection or wrench
  double delay = 0;      ///< s, estimated beside every linear effect that could look like one
  double deviation = 0;  ///< s, standard deviation
};

/// Delays of all groups whose clock the recordings can tell, beside what is `known` already. The
/// dictionary is of the machine of `known`.
std::vector<ClockCheck> check_clocks(const Observations& observations,
                                     const std::vector<Hypothesis>& hypotheses,
                                     const Dictionary& dictionary, const Fit& known);

}  // namespace flexcomp::diagnosis
