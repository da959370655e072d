#pragma once

#include <string>

namespace flexcomp::report {

/// Text as it must stand in HTML, in attributes too.
std::string escaped(const std::string& text);

}  // namespace flexcomp::report
