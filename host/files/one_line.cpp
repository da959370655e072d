#include "files/one_line.hpp"

#include <cctype>

namespace flexcomp::files {

std::string one_line(std::string_view text, std::size_t longest) {
  std::string shown;
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    const char visible = std::isspace(byte) != 0 ? ' ' : '?';
    shown += std::isprint(byte) != 0 ? c : visible;
  }
  return text.size() > longest ? shown + "..." : shown;
}

}  // namespace flexcomp::files
