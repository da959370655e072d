#include "programs/gcode_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "files/one_line.hpp"

namespace flexcomp::programs {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

char capital(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// Skips blanks, which RS274 allows anywhere.
std::size_t skip_blanks(std::string_view line, std::size_t at) {
  while (at < line.size() && is_blank(line[at])) {
    ++at;
  }
  return at;
}

/// The number at a place, its end in `at`; false if there is none.
bool read_number(std::string_view line, std::size_t* at, double* number) {
  std::size_t begin = skip_blanks(line, *at);
  const bool has_sign = begin < line.size() && (line[begin] == '+' || line[begin] == '-');
  const bool is_negative = has_sign && line[begin] == '-';
  if (has_sign) {
    begin = skip_blanks(line, begin + 1);
  }
  const bool has_digit =
      begin < line.size() && ((line[begin] >= '0' && line[begin] <= '9') || line[begin] == '.');
  if (!has_digit) {
    return false;
  }
  const char* const end = line.data() + line.size();
  const auto result = std::from_chars(line.data() + begin, end, *number, std::chars_format::fixed);
  if (result.ec != std::errc{} || !(std::abs(*number) < 1e9)) {
    return false;
  }
  *number = is_negative ? -*number : *number;
  *at = static_cast<std::size_t>(result.ptr - line.data());
  return true;
}

}  // namespace

int Word::code() const {
  const double tenths = 10 * number;
  const double whole = std::round(tenths);
  return std::abs(tenths - whole) < 1e-6 && whole >= 0 && whole < 10000 ? static_cast<int>(whole)
                                                                        : -1;
}

std::string read_words(std::string_view line, std::vector<Word>* words) {
  words->clear();
  std::size_t at = skip_blanks(line, 0);
  if (at < line.size() && (line[at] == '/' || line[at] == '%')) {
    ++at;
  }
  for (at = skip_blanks(line, at); at < line.size(); at = skip_blanks(line, at)) {
    if (line[at] == ';') {
      break;
    }
    if (line[at] == '(') {
      const std::size_t close = line.find(')', at);
      if (close == std::string_view::npos) {
        return "a comment without its closing bracket";
      }
      at = close + 1;
      continue;
    }
    if (!is_letter(line[at])) {
      return fmt::format("'{}' begins no word; expected a letter and a number",
                         files::one_line(line.substr(at), 20));
    }
    Word word;
    word.letter = capital(line[at]);
    word.begin = at++;
    if (!read_number(line, &at, &word.number)) {
      return fmt::format("'{}': expected a number after {}",
                         files::one_line(line.substr(word.begin), 20), word.letter);
    }
    word.finish = at;
    words->push_back(word);
  }
  return {};
}

bool goes_to_machine_place(const std::vector<Word>& words) {
  return std::any_of(words.begin(), words.end(), [](const Word& word) {
    return word.letter == 'G' && (word.code() == 280 || word.code() == 300 || word.code() == 530);
  });
}

}  // namespace flexcomp::programs
