#include "model/one_line.hpp"

#include <algorithm>
#include <cctype>

namespace flexcomp::model {

std::string one_line(std::string_view text, std::size_t longest) {
  std::string shown(text.substr(0, longest));
  std::replace_if(
      shown.begin(), shown.end(),
      [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, ' ');
  return text.size() > longest ? shown + "..." : shown;
}

}  // namespace flexcomp::model
