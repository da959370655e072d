#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "programs/gcode_words.hpp"

namespace flexcomp::programs {

/// Values of a line's words by letter, all but those of G and M.
class GcodeLine {
 public:
  explicit GcodeLine(const std::vector<Word>& words) {
    for (const Word& word : words) {
      if (word.letter != 'G' && word.letter != 'M') {
        is_twice_ = is_twice_ || has(word.letter);
        has_[index(word.letter)] = true;
        value_[index(word.letter)] = word.number;
      }
    }
  }

  bool has(char letter) const { return has_[index(letter)]; }
  bool has_any(std::string_view letters) const {
    return std::any_of(letters.begin(), letters.end(), [&](char c) { return has(c); });
  }
  double value(char letter) const { return value_[index(letter)]; }
  bool holds_a_letter_twice() const { return is_twice_; }

 private:
  static std::size_t index(char letter) { return static_cast<std::size_t>(letter - 'A'); }

  std::array<bool, 26> has_{};
  std::array<double, 26> value_{};
  bool is_twice_ = false;
};

}  // namespace flexcomp::programs
