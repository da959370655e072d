#include "recording/lines.hpp"

#include <fmt/format.h>

#include "error.hpp"

namespace flexcomp::recording {

std::string_view trimmed(std::string_view cell) {
  const auto begin = cell.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    return {};
  }
  return cell.substr(begin, cell.find_last_not_of(" \t") - begin + 1);
}

void refuse_long_line(const std::string& file, std::size_t number, std::string_view line) {
  constexpr std::size_t kLongestLine = 1 << 16;
  if (line.size() > kLongestLine) {
    throw InputError(fmt::format("{}:{}: the line has {} characters; expected at most {}", file,
                                 number, line.size(), kLongestLine));
  }
}

Lines::Lines(std::string_view text) : rest_(text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    rest_.remove_prefix(kByteOrderMark.size());
  }
}

bool Lines::next(std::string_view* line) {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    *line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    if (!line->empty() && line->back() == '\r') {
      line->remove_suffix(1);
    }
    if (!trimmed(*line).empty()) {
      return true;
    }
  }
  return false;
}

}  // namespace flexcomp::recording
