#pragma once

#include <string>
#include <string_view>

namespace flexcomp::programs {

/// A RAPID statement without its comments and without the semicolon that ends it. Headers of
/// blocks, which end with their line, are statements too.
struct RapidStatement {
  std::string text;
  std::size_t line = 0;   ///< that it begins in, from 1
  std::size_t begin = 0;  ///< bytes of the program: [begin, finish), the semicolon included
  std::size_t finish = 0;
};

/// Hands out the statements of a RAPID module. An exclamation mark begins a comment, outside of
/// quotation marks.
class RapidStatements {
 public:
  explicit RapidStatements(std::string_view text) : text_(text) {}

  /// From a byte of the text on, which stands in this line.
  RapidStatements(std::string_view text, std::size_t begin, std::size_t line)
      : text_(text), at_(begin), line_(line) {}

  /// The next statement; false at the end.
  bool next(RapidStatement* statement);

 private:
  void skip_blanks();
  void skip_comment();
  void skip_file_header();  ///< version and language between two lines of %%%

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace flexcomp::programs
