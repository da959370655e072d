#pragma once

#include <string>

namespace flexcomp::cli {

/// Every effect of the catalogue as a list `effects` of robot.yaml takes it: name, what it says of
/// the machine, and of each form its parameters with units.
std::string effects_help();

}  // namespace flexcomp::cli
