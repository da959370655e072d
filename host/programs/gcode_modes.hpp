#pragma once

#include <vector>

#include "programs/gcode_words.hpp"
#include "programs/program.hpp"

namespace flexcomp::programs {

/// Modes of G-code that say what the numbers of a line mean.
struct GcodeModes {
  double unit = kMillimetre;        ///< m: G21, or G20
  bool is_relative = false;         ///< G91, not G90
  bool is_center_absolute = false;  ///< G90.1, not G91.1
  bool is_inverse_time = false;     ///< G93, not G94
  double feed = 0;                  ///< number of the last F; zero where there is none

  /// Takes what a line sets of these. A feed holds only as long as G93 or G94 does.
  void read(const std::vector<Word>& words);

 private:
  void read_code(int code);
  void set_inverse_time(bool is_inverse);
};

}  // namespace flexcomp::programs
