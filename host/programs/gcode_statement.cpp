#include "programs/gcode_statement.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "programs/gcode_words.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

template <std::size_t Count>
bool has_code(const Word& word, char letter, const std::array<int, Count>& codes) {
  return word.letter == letter && std::find(codes.begin(), codes.end(), word.code()) != codes.end();
}

bool is_of_motion(const Word& word, const GcodeOmission& omission) {
  constexpr std::array<int, 8> kMotion = {0, 10, 20, 30, 900, 910, 901, 911};
  constexpr std::array<int, 2> kFeed = {930, 940};
  return has_code(word, 'G', kMotion) ||
         std::string_view("XYZABCIJKR").find(word.letter) != std::string_view::npos ||
         (omission.is_arc && word.letter == 'P') ||
         (omission.has_feed && (word.letter == 'F' || has_code(word, 'G', kFeed)));
}

bool is_stop(const Word& word) {
  constexpr std::array<int, 5> kStops = {0, 10, 20, 300, 600};
  return has_code(word, 'M', kStops);
}

void erase_word(const Word& word, std::string* line) {
  line->erase(word.begin, word.finish - word.begin);
  while (word.begin < line->size() && word.begin > 0 && (*line)[word.begin] == ' ' &&
         (*line)[word.begin - 1] == ' ') {
    line->erase(word.begin, 1);
  }
}

}  // namespace

GcodeStatement gcode_statement(std::string_view line, const GcodeOmission& omission,
                               bool splits_stops) {
  GcodeStatement statement;
  std::string text(line);
  std::vector<Word> words;
  read_words(line, &words);
  const std::size_t first = std::min(text.find_first_not_of(" \t\r"), text.size());
  const bool has_mark = first < text.size() && (text[first] == '/' || text[first] == '%');
  const bool has_number = !words.empty() && words.front().letter == 'N';
  const std::size_t end = has_number ? words.front().finish : has_mark ? first + 1 : 0;
  statement.is_skippable = has_mark && text[first] == '/';
  statement.prefix = text.substr(0, end);
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const bool is_split = splits_stops && is_stop(*word);
    if (is_split) {
      statement.stops.insert(0, " " + text.substr(word->begin, word->finish - word->begin));
    }
    if (is_split || is_of_motion(*word, omission)) {
      erase_word(*word, &text);
    }
  }
  statement.rest = trimmed_line(std::string_view(text).substr(end));
  return statement;
}

}  // namespace flexcomp::programs
