#pragma once

#include <string_view>

namespace flexcomp {

/// Says something on standard error, as one printable line that begins with the program's name.
/// All that flexcompd says goes through here.
void complain(std::string_view message);

}  // namespace flexcomp
