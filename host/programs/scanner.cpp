#include "programs/scanner.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace flexcomp::programs {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_of_a_name(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '$';
}

}  // namespace

bool Scanner::at_end() { return peek() == 0; }

char Scanner::peek() {
  constexpr std::string_view kBlanks = " \t\r\n";
  while (at_ < text_.size() && kBlanks.find(text_[at_]) != std::string_view::npos) {
    ++at_;
  }
  return at_ < text_.size() ? text_[at_] : '\0';
}

bool Scanner::take(char c) {
  if (peek() != c || c == '\0') {
    return false;
  }
  ++at_;
  return true;
}

std::string Scanner::name() {
  std::string name;
  if (!is_of_a_name(peek())) {
    return name;
  }
  while (at_ < text_.size() &&
         (is_of_a_name(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) {
    const char c = text_[at_++];
    name += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return name;
}

std::optional<double> Scanner::number() {
  const std::size_t start = at_;
  const bool is_negative = take('-');
  if (!is_negative) {
    take('+');
  }
  const char first = peek();
  double value = 0;
  if (is_digit(first) || first == '.') {
    const auto result = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (result.ec == std::errc{} && std::isfinite(value)) {
      at_ = static_cast<std::size_t>(result.ptr - text_.data());
      return is_negative ? -value : value;
    }
  }
  at_ = start;
  return std::nullopt;
}

std::string_view trimmed_line(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = line.find_first_not_of(kBlanks);
  return begin == std::string_view::npos
             ? std::string_view{}
             : line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

std::string_view next_line(std::string_view text, std::size_t* begin) {
  const std::size_t end = std::min(text.find('\n', *begin), text.size());
  const std::string_view line = text.substr(*begin, end - *begin);
  *begin = end + 1;
  return line;
}

}  // namespace flexcomp::programs
