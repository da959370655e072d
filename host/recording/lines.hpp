#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace flexcomp::recording {

/// Without blanks and tabs at its ends.
std::string_view trimmed(std::string_view cell);

/// Throws InputError with file and line for a line of more than 64 KiB: a recording's has some
/// hundred characters, and one of a gigabyte without a line end is no table.
void refuse_long_line(const std::string& file, std::size_t number, std::string_view line);

/// Hands out a text's lines without their ends and without a byte-order mark.
class Lines {
 public:
  explicit Lines(std::string_view text);

  /// Next line that is not blank; false at the end.
  bool next(std::string_view* line);

  /// Line of the text that was handed out last, from 1.
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace flexcomp::recording
