#include "programs/gcode_reader.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/gcode_arc.hpp"
#include "programs/gcode_words.hpp"

namespace flexcomp::programs {
namespace {

/// Values of a line's words by letter.
class Line {
 public:
  explicit Line(const std::vector<Word>& words) {
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
      read_line(text.substr(begin, end - begin));
      begin = end + 1;
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

  void read_line(std::string_view text) {
    const std::string wrong = read_words(text, &words_);
    if (!wrong.empty()) {
      fail(wrong);
    }
    const Line line(words_);
    if (line.holds_a_letter_twice()) {
      fail("a letter stands twice in the line");
    }
    has_motion_word_ = false;
    goes_to_machine_place_ = false;
    takes_p_ = false;
    for (const Word& word : words_) {
      read_word(word);
    }
    if (line.has('F')) {
      read_feed(line.value('F'));
    }
    refuse_loose_words(line);
    const bool is_circle = (motion_ == 2 || motion_ == 3) && line.has_any("IJK");
    if (line.has_any("XYZABC") || is_circle) {
      if (goes_to_machine_place_) {
        program_.notes.push_back({line_, "goes to a place of the machine: left as it is"});
      } else {
        move(line);
      }
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
      case 200:
        unit_ = kInch;
        break;
      case 210:
        unit_ = kMillimetre;
        break;
      case 280:
      case 300:
      case 530:
        goes_to_machine_place_ = true;
        break;
      case 800:
        motion_ = -1;
        break;
      case 900:
        is_relative_ = false;
        break;
      case 910:
        is_relative_ = true;
        break;
      case 901:
        is_center_absolute_ = true;
        break;
      case 911:
        is_center_absolute_ = false;
        break;
      case 930:
        is_inverse_time_ = true;
        break;
      case 940:
        is_inverse_time_ = false;
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
    constexpr std::array<int, 7> kWithoutMotion = {400, 430, 434, 490, 970, 980, 990};
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
      case 50:
        is_spinning_ = false;
        has_spindle_ = true;
        break;
      case 0:
      case 10:
      case 60:
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

  void read_feed(double feed) {
    if (!(feed > 0)) {
      fail(fmt::format("'F{:g}': a feed must be above zero", feed));
    }
    feed_ = feed;
  }

  void refuse_loose_words(const Line& line) const {
    const bool is_arc = motion_ == 2 || motion_ == 3;
    const bool moves = line.has_any("XYZABC");
    if (line.has('P') && !takes_p_ && !is_arc) {
      fail("'P': goes with G4, G64 and arcs alone");
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

  double length(double value) const { return unit_ * value; }

  void move(const Line& line) {
    const Vector3<double> start = at_;
    for (int axis = 0; axis < 3; ++axis) {
      set_axis(line, static_cast<char>('X' + axis), unit_, &at_[axis]);
      set_axis(line, static_cast<char>('A' + axis), kDegree, &turn_[axis]);
    }
    Motion motion;
    motion.kind = motion_ == 0   ? MotionKind::rapid
                  : motion_ == 1 ? MotionKind::linear
                                 : MotionKind::circular;
    motion.end = {orientation(), at_};
    motion.line = line_;
    motion.begin = begin_;
    motion.finish = finish_;
    motion.is_cutting = is_spinning_ && motion.kind != MotionKind::rapid;
    if (motion.kind == MotionKind::circular) {
      motion.arc = arc_of(line, start);
    }
    if (motion.kind != MotionKind::rapid) {
      motion.feed = feed_of(motion, start, line);
    }
    append(motion, &program_);
  }

  void set_axis(const Line& line, char letter, double unit, double* value) const {
    if (line.has(letter)) {
      *value = (is_relative_ ? *value : 0) + unit * line.value(letter);
    }
  }

  Matrix3<double> orientation() const {
    using Eigen::AngleAxisd;
    using Vector = Vector3<double>;
    return (AngleAxisd(turn_[2], Vector::UnitZ()) * AngleAxisd(turn_[1], Vector::UnitY()) *
            AngleAxisd(turn_[0], Vector::UnitX()) * AngleAxisd(M_PI, Vector::UnitX()))
        .toRotationMatrix();
  }

  double feed_of(const Motion& motion, const Vector3<double>& start, const Line& line) const {
    if (feed_ == 0 || (is_inverse_time_ && !line.has('F'))) {
      fail("the feed is missing: expected F");
    }
    return is_inverse_time_ ? length_of({motion.end.rotation, start}, motion) * feed_ / 60
                            : length(feed_) / 60;
  }

  Arc arc_of(const Line& line, const Vector3<double>& start) const {
    const ArcRequest request{start, at_, normal_, motion_ == 2};
    Arc arc;
    const std::string wrong = line.has('R') ? arc_by_radius(request, length(line.value('R')), &arc)
                                            : arc_by_center(request, center_of(line, start), &arc);
    if (!wrong.empty()) {
      fail(wrong);
    }
    add_turns(line, &arc);
    return arc;
  }

  Vector3<double> center_of(const Line& line, const Vector3<double>& start) const {
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
        center[axis] = (is_center_absolute_ ? 0 : start[axis]) + length(line.value(letter));
      }
    }
    return center;
  }

  void add_turns(const Line& line, Arc* arc) const {
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

  double unit_ = kMillimetre;
  int normal_ = 2;  // axis across the plane of arcs
  int motion_ = -1;
  int offset_ = 0;
  double feed_ = 0;
  bool is_relative_ = false;
  bool is_center_absolute_ = false;
  bool is_inverse_time_ = false;
  bool is_spinning_ = false;
  bool has_spindle_ = false;
  bool has_motion_word_ = false;
  bool goes_to_machine_place_ = false;
  bool takes_p_ = false;
  Vector3<double> at_ = Vector3<double>::Zero();
  Vector3<double> turn_ = Vector3<double>::Zero();
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
