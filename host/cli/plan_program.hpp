#pragma once

#include "cli/command.hpp"

namespace flexcomp::cli {

/// F_C and M of Klimchik et al. (2017), section 4: out of the circle, along the feed, along the
/// normal.
constexpr std::array<double, 3> kStudyForce = {440, 1370, 635};
constexpr std::array<double, 3> kStudyMoment = {0, 3, 10.5};

/// Adds `plan program`, `plan line` and `plan pocket`.
void add_plan_program(CLI::App* plan, Action* action);

}  // namespace flexcomp::cli
