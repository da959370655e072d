#pragma once

#include <string>

namespace flexcomp::cli {

/// Every effect of the catalogue as a list `effects` of robot.yaml takes it: name, what it says of
/// the machine, and of each form its parameters with units. Of one effect alone unless `name` is
/// empty; empty where there is none.
std::string effects_help(const std::string& name);

}  // namespace flexcomp::cli
