#include "programs/gcode_modes.hpp"

namespace flexcomp::programs {

void GcodeModes::read(const std::vector<Word>& words) {
  for (const Word& word : words) {
    if (word.letter == 'G') {
      read_code(word.code());
    }
  }
  for (const Word& word : words) {
    feed = word.letter == 'F' ? word.number : feed;
  }
}

void GcodeModes::read_code(int code) {
  switch (code) {
    case 200:
      unit = kInch;
      break;
    case 210:
      unit = kMillimetre;
      break;
    case 900:
    case 910:
      is_relative = code == 910;
      break;
    case 901:
    case 911:
      is_center_absolute = code == 901;
      break;
    case 930:
    case 940:
      set_inverse_time(code == 930);
      break;
    default:
      break;
  }
}

void GcodeModes::set_inverse_time(bool is_inverse) {
  feed = is_inverse == is_inverse_time ? feed : 0;
  is_inverse_time = is_inverse;
}

}  // namespace flexcomp::programs
