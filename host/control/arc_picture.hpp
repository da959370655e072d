#pragma once

#include <string>

#include "control/arc_design.hpp"

namespace flexcomp::control {

/// A gnuplot script of the cost over both gains of a joint, in units of its least, by colour and
/// contours, with the optimum and the gains in use marked.
std::string cost_script(const ArcPart<3>& link_part, const ArcPart<4>& motor_part,
                        const std::string& title);

}  // namespace flexcomp::control
