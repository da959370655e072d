#include "programs/gcode_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/gcode_arc.hpp"
#include "programs/gcode_axes.hpp"
#include "programs/gcode_line.hpp"
#include "programs/gcode_modes.hpp"
#include "programs/gcode_words.hpp"

namespace flexcomp::programs {
namespace {

class GcodeReader {
 public:
  explicit GcodeReader(Program* program) : program_(*program) {}

  void read() {
    const std::string_view text = program_.text;
    std::size_t begin = 0;
    while (begin < text.size() && !is_over_) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      begin_ = begin;
      finish_ = end;
      const std::string_view line = text.substr(begin, end - begin);
      begin = std::min(end + 1, text.size());
      if (begins_with('%', line) && has_begun_) {
        end_at_percent(text.substr(begin));
      } else {
        read_line(line);
        has_begun_ = has_begun_ || begins_with('%', line) || !words_.empty();
      }
    }
    if (!has_spindle_) {  // a program that never says so cuts wherever it feeds
      for (Motion& motion : program_.motions) {
        motion.is_cutting = motion.kind != MotionKind::rapid;
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse(program_.file, line_, why); }

  [[noreturn]] void fail_at(const Word& word, const std::string& why) const {
    fail(fmt::format("'{}{:g}': {}", word.letter, word.number, why));
  }

  void note(const std::string& text) { program_.notes.push_back({line_, text}); }

  void read_line(std::string_view text) {
    const std::string wrong = read_words(text, &words_);
    if (!wrong.empty()) {
      fail(wrong);
    }
    const GcodeLine line(words_);
    if (line.holds_a_letter_twice()) {
      fail("a letter stands twice in the line");
    }
    has_motion_word_ = false;
    goes_to_machine_place_ = goes_to_machine_place(words_);
    takes_p_ = false;
    has_dwell_ = false;
    modes_.read(words_);
    for (const Word& word : words_) {
      read_word(word);
    }
    if (line.has('F') && !(line.value('F') > 0)) {
      fail(fmt::format("'F{:g}': a feed must be above zero", line.value('F')));
    }
    refuse_loose_words(line);
    const bool is_circle = (motion_ == 2 || motion_ == 3) && line.has_any("IJK");
    if (goes_to_machine_place_) {
      note("goes to a place of the machine: left as it is");
      axes_.lose_named(line, line_);
    } else if (line.has_any("XYZABC") || is_circle) {
      move(line);
    }
  }

  /// Is this a line's first character, behind blanks?
  static bool begins_with(char mark, std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first != std::string_view::npos && line[first] == mark;
  }

  /// A file may stand between two lines of a percent sign; what follows is none of the program.
  void end_at_percent(std::string_view behind) {
    is_over_ = true;
    if (behind.find_first_not_of(" \t\r\n") != std::string_view::npos) {
      note("the program ends at this '%'; what stands behind it is not read");
    }
  }

  void read_word(const Word& word) {
    switch (word.letter) {
      case 'G':
        read_g(word);
        break;
      case 'M':
        read_m(word);
        break;
      default:
        if (std::string_view("ABCDFHIJKNOPQRSTXYZ").find(word.letter) == std::string_view::npos) {
          fail_at(word, "unknown word");
        }
    }
  }

  void read_g(const Word& word) {
    switch (word.code()) {
      case 0:
      case 10:
      case 20:
      case 30:
        if (has_motion_word_) {
          fail_at(word, "a second motion in the line");
        }
        has_motion_word_ = true;
        motion_ = word.code() / 10;
        break;
      case 40:
        has_dwell_ = true;
        takes_p_ = true;
        note("the path does not wait here: a dwell has no time in it");
        break;
      case 610:
      case 611:
      case 640:
        takes_p_ = true;
        break;
      case 170:
        normal_ = 2;
        break;
      case 180:
        normal_ = 1;
        break;
      case 190:
        normal_ = 0;
        break;
      case 280:
      case 300:
      case 530:
        takes_p_ = takes_p_ || word.code() == 300;  // which of the places
        break;
      case 800:
        motion_ = -1;
        break;
      case 410:
      case 420:
        fail_at(word, "cutter compensation is not computed; program the middle of the tool");
      default:
        read_other_g(word);
    }
  }

  void read_other_g(const Word& word) {
    const int code = word.code();
    constexpr std::array<int, 15> kWithoutMotion = {200, 210, 400, 430, 434, 490, 900, 901,
                                                    910, 911, 930, 940, 970, 980, 990};
    if (std::find(kWithoutMotion.begin(), kWithoutMotion.end(), code) != kWithoutMotion.end()) {
      return;
    }
    if ((code >= 540 && code <= 590 && code % 10 == 0) || (code > 590 && code <= 593)) {
      if (offset_ != 0 && offset_ != code) {
        fail_at(word, "a second work offset; one work frame is planned at a time");
      }
      offset_ = code;
      return;
    }
    fail_at(word, "unknown word");
  }

  void read_m(const Word& word) {
    switch (word.code()) {
      case 20:
      case 300:
        is_over_ = true;
        break;
      case 30:
      case 40:
        is_spinning_ = true;
        has_spindle_ = true;
        break;
      case 60:
        axes_.lose_tip(line_);
        break;
      case 50:
        is_spinning_ = false;
        has_spindle_ = true;
        break;
      case 0:
      case 10:
      case 70:
      case 80:
      case 90:
      case 480:
      case 490:
      case 600:
        break;
      default:
        fail_at(word, "unknown word");
    }
  }

  void refuse_loose_words(const GcodeLine& line) const {
    const bool is_arc = motion_ == 2 || motion_ == 3;
    const bool moves = line.has_any("XYZABC");
    if (line.has('P') && !takes_p_ && !is_arc) {
      fail("'P': goes with G4, G30, G64 and arcs alone");
    }
    if (moves && has_dwell_) {
      fail("a dwell with an axis; expected G4 and P");
    }
    if (has_dwell_ && line.has('F') && !line.has('P')) {
      fail("'F' beside G4: a dwell in seconds (Siemens) or a feed? expected G4 and P");
    }
    if (line.has('Q') && !takes_p_) {
      fail("'Q': unknown word");
    }
    if (line.has_any("IJKR") && !is_arc) {
      fail("I, J, K and R go with G2 and G3 alone");
    }
    if (line.has('R') && line.has_any("IJK")) {
      fail("an arc with both R and I, J or K");
    }
    if (moves && motion_ < 0 && !goes_to_machine_place_) {
      fail("axes without a motion: G0, G1, G2 or G3 is missing");
    }
  }

  void move(const GcodeLine& line) {
    const GcodeAxes start = axes_;
    axes_.go(line, modes_);
    if (motion_ != 0) {
      refuse_unknown_start(line, start);
    }
    if (!axes_.are_known()) {
      note(axes_.why_unknown() + "; left as it is");
      return;
    }
    note_block_delete();
    Motion motion;
    motion.kind = motion_ == 0   ? MotionKind::rapid
                  : motion_ == 1 ? MotionKind::linear
                                 : MotionKind::circular;
    motion.end = {axes_.orientation(), axes_.place()};
    motion.has_known_start = start.are_known();
    motion.line = line_;
    motion.begin = begin_;
    motion.finish = finish_;
    motion.is_cutting = is_spinning_ && motion.kind != MotionKind::rapid;
    if (motion.kind == MotionKind::circular) {
      motion.arc = arc_of(line, start.place());
    }
    if (motion.kind != MotionKind::rapid) {
      set_feed(line, start, &motion);
    }
    if (!motion.has_known_start && !program_.motions.empty()) {
      note(fmt::format("{}; the way here from line {} is planned as straight", start.why_unknown(),
                       program_.motions.back().line));
    }
    append(motion, &program_);
  }

  void note_block_delete() {
    const std::string_view line(program_.text.data() + begin_, finish_ - begin_);
    if (!has_block_delete_ && begins_with('/', line)) {
      has_block_delete_ = true;
      note("lines with a '/' are planned as if they are run");
    }
  }

  /// A cut is planned from a place that is known alone. The first motion's way is not planned.
  void refuse_unknown_start(const GcodeLine& line, const GcodeAxes& start) const {
    const bool is_first_point = program_.motions.empty() && motion_ == 1 && !modes_.is_relative &&
                                line.has('X') && line.has('Y') && line.has('Z');
    if (!start.are_known() && !(is_first_point && axes_.are_known())) {
      fail(start.why_unknown() + "; a motion at a feed begins where G0 has told X, Y and Z");
    }
  }

  /// In G93 a motion takes a share of a minute. In G94 the feed is of X, Y and Z where one of them
  /// moves, else degrees a minute of A, B and C as if they were at right angles (NISTIR 6556,
  /// 2.1.2.5).
  void set_feed(const GcodeLine& line, const GcodeAxes& start, Motion* motion) const {
    if (modes_.feed == 0 || (modes_.is_inverse_time && !line.has('F'))) {
      fail("the feed is missing: expected F");
    }
    constexpr double kStands = 1e-9;  // m
    const double rate = modes_.feed / 60;
    const Pose<double> from =
        start.are_known() ? Pose<double>{start.orientation(), start.place()} : motion->end;
    const double way = length_of(from, *motion);
    const double turn = way > kStands ? 0 : turn_between(from.rotation, motion->end.rotation);
    if (modes_.is_inverse_time) {
      motion->feed = way > kStands ? way * rate : 0;
      motion->turn_feed = turn * rate;
    } else if (turn > 0) {
      motion->turn_feed = turn * kDegree * rate / (axes_.turn() - start.turn()).norm();
    } else {
      motion->feed = length(rate);
    }
  }

  double length(double value) const { return modes_.unit * value; }

  Arc arc_of(const GcodeLine& line, const Vector3<double>& start) const {
    const ArcRequest request{start, axes_.place(), normal_, motion_ == 2};
    Arc arc;
    const std::string wrong = line.has('R') ? arc_by_radius(request, length(line.value('R')), &arc)
                                            : arc_by_center(request, center_of(line, start), &arc);
    if (!wrong.empty()) {
      fail(wrong);
    }
    add_turns(line, &arc);
    return arc;
  }

  Vector3<double> center_of(const GcodeLine& line, const Vector3<double>& start) const {
    if (!line.has_any("IJK")) {
      fail("an arc without its middle; expected I, J, K or R");
    }
    Vector3<double> center = start;
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = static_cast<char>('I' + axis);
      if (line.has(letter) && axis == normal_) {
        fail("the middle of an arc lies in its plane (G17: I, J; G18: I, K; G19: J, K)");
      }
      if (line.has(letter)) {
        center[axis] = (modes_.is_center_absolute ? 0 : start[axis]) + length(line.value(letter));
      }
    }
    return center;
  }

  void add_turns(const GcodeLine& line, Arc* arc) const {
    if (!line.has('P')) {
      return;
    }
    const double turns = line.value('P');
    if (!(turns >= 1 && turns <= 1000 && turns == std::floor(turns))) {
      fail("'P': expected the arc's turns, 1 to 1000");
    }
    arc->angle += 2 * M_PI * (turns - 1);
  }

  Program& program_;
  std::vector<Word> words_;
  std::size_t line_ = 0;
  std::size_t begin_ = 0;
  std::size_t finish_ = 0;
  bool is_over_ = false;
  bool has_begun_ = false;  // with a percent sign or a word

  GcodeModes modes_;
  GcodeAxes axes_;
  int normal_ = 2;  // axis across the plane of arcs
  int motion_ = -1;
  int offset_ = 0;
  bool is_spinning_ = false;
  bool has_spindle_ = false;
  bool has_motion_word_ = false;
  bool goes_to_machine_place_ = false;
  bool takes_p_ = false;
  bool has_block_delete_ = false;  // in a line that moves
  bool has_dwell_ = false;
};

}  // namespace

Program gcode_program(const std::string& file, std::string text) {
  Program program = unread(Format::gcode, file, std::move(text));
  program.has_free_spin = true;
  GcodeReader(&program).read();
  return program;
}

Program read_gcode(const std::filesystem::path& file) {
  return gcode_program(file.string(), files::read_text(file));
}

}  // namespace flexcomp::programs
