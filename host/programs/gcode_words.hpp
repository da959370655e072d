#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexcomp::programs {

/// A word of G-code: a letter and its number.
struct Word {
  char letter = 0;  ///< a capital
  double number = 0;
  std::size_t begin = 0;  ///< in the line, of [begin, finish)
  std::size_t finish = 0;

  /// A code by ten: 17 is 170, 43.4 is 434.
  int code() const;
};

/// The words of a line of G-code (RS274/NGC, Kramer et al., NISTIR 6556, 3.3), comments left out:
/// in brackets, or from a semicolon to the end. A block delete slash and % are no words.
///
/// Returns the words in `words`, and nothing or a sentence that says what is wrong.
std::string read_words(std::string_view line, std::vector<Word>* words);

/// Do the words of a line name places of the machine: G28, G30 and G53?
bool goes_to_machine_place(const std::vector<Word>& words);

}  // namespace flexcomp::programs
