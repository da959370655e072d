#pragma once

#include <string>
#include <string_view>

namespace flexcomp::files {

/// Text from a file as it may stand in a message: line ends and tabs as spaces, other bytes that
/// are not printable ASCII as question marks, cut to `longest` bytes.
std::string one_line(std::string_view text, std::size_t longest = 60);

}  // namespace flexcomp::files
