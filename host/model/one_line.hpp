#pragma once

#include <string>
#include <string_view>

namespace flexcomp::model {

/// Text from a file as it may stand in a message: control characters as spaces, cut to `longest`
/// bytes.
std::string one_line(std::string_view text, std::size_t longest = 60);

}  // namespace flexcomp::model
