#include "linux/complaint.hpp"

#include <cstdio>
#include <string>

#include "linux/printable_line.hpp"

namespace flexcomp {

void complain(std::string_view message) {
  const std::string line = "flexcompd: " + printable_line(message) + '\n';
  std::fputs(line.c_str(), stderr);
}

}  // namespace flexcomp
