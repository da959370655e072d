#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace flexcomp::programs {

/// Hands out the words, numbers and signs of a robot program's statement.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  /// Skips blanks and line ends; is nothing left?
  bool at_end();

  /// The next character after blanks, without taking it; 0 at the end.
  char peek();

  /// Takes the next character if it is this one.
  bool take(char c);

  /// A name in capitals: letters, digits, and any of `_$.`; empty if the next character begins
  /// none.
  std::string name();

  /// A number with or without a sign; nothing if there is none, or if it is not finite.
  std::optional<double> number();

  /// The rest of the text, as it stands.
  std::string_view rest() const { return text_.substr(at_); }

  std::size_t place() const { return at_; }
  void go_to(std::size_t place) { at_ = place; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// A line without the blanks, tabs and returns around it.
std::string_view trimmed_line(std::string_view line);

/// Takes from a text its next line, without the line's end.
std::string_view next_line(std::string_view text, std::size_t* begin);

}  // namespace flexcomp::programs
