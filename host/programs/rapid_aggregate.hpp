#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// The numbers of a RAPID aggregate such as [[1,2,3],[1,0,0,0]], brackets, truth values and texts
/// left out; nothing if anything else stands in it.
std::optional<std::vector<double>> read_rapid_numbers(Scanner* scanner);

/// The parts of a target in brackets behind its place and orientation, ",[0,0,0,0],[9E9,…]" as they
/// stand; those of a target without any if there are none.
std::string rapid_configuration(std::string_view target);

}  // namespace flexcomp::programs
