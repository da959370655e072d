#pragma once

#include <string>

#include "control/gain_cost.hpp"

namespace flexcomp::control {

/// A gnuplot script of the cost over both gains of a joint, in units of its least, by colour and
/// contours, with the optimum marked.
std::string cost_script(const GainCost& link, const GainCost& motor, const std::string& title);

}  // namespace flexcomp::control
