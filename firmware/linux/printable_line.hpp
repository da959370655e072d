#pragma once

#include <string>
#include <string_view>

namespace flexcomp {

/// A message as it may reach a terminal: one line, without control characters.
///
/// Messages quote what stands in files and arguments, and an escape sequence there could move the
/// cursor, name the window or hide what follows. Line ends and tabs become spaces. A question mark
/// takes the place of every other control character (C0, DEL, C1), of what turns the direction of
/// writing round or ends a line in Unicode, and of bytes that are not UTF-8.
std::string printable_line(std::string_view text);

}  // namespace flexcomp
