#include "programs/gcode_writer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "programs/gcode_words.hpp"
#include "programs/krl_point.hpp"
#include "programs/rewriting.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

/// Words that the writer gives anew, of a line that moves.
bool is_replaced(const Word& word) {
  constexpr std::array<int, 10> kCodes = {0, 10, 20, 30, 900, 910, 901, 911, 930, 940};
  if (word.letter == 'G') {
    return std::find(kCodes.begin(), kCodes.end(), word.code()) != kCodes.end();
  }
  return std::string_view("XYZABCIJKRPF").find(word.letter) != std::string_view::npos;
}

class GcodeWriter {
 public:
  explicit GcodeWriter(const CorrectedProgram& program)
      : program_(program), source_(program.source) {
    const Matrix3<double> down = orientation_by_axis(Vector3<double>::UnitZ());
    has_angles_ = std::any_of(
        source_.motions.begin(), source_.motions.end(),
        [&](const Motion& each) { return (each.end.rotation.col(2) - down.col(2)).norm() > 1e-9; });
    if (source_.format == Format::gcode) {
      read_units();
    }
  }

  std::string rewritten_text() {
    return rewritten(source_, [&](std::size_t motion) { return line_in_place(motion); });
  }

  std::string new_text() {
    std::string origin = origin_of(program_);  // a file's name may have what ends a comment
    std::replace(origin.begin(), origin.end(), '(', '[');
    std::replace(origin.begin(), origin.end(), ')', ']');
    std::string text = fmt::format("({})\nG21 G90 G94 G17\n", origin);
    for (std::size_t i = 0; i < source_.motions.size(); ++i) {
      text += lines_of(i, "\n") + "\n";
    }
    return text + "M2\n";
  }

 private:
  /// The unit that holds in each line that moves.
  void read_units() {
    units_.assign(source_.motions.size(), kMillimetre);
    std::vector<Word> words;
    std::size_t motion = 0;
    double unit = kMillimetre;
    std::size_t number = 0;
    for (std::size_t begin = 0; begin < source_.text.size() && motion < units_.size();) {
      read_words(next_line(source_.text, &begin), &words);
      ++number;
      for (const Word& word : words) {
        unit = word.letter == 'G' && word.code() == 200   ? kInch
               : word.letter == 'G' && word.code() == 210 ? kMillimetre
                                                          : unit;
      }
      if (source_.motions[motion].line == number) {
        units_[motion++] = unit;
      }
    }
  }

  double unit_of(std::size_t motion) const { return units_.empty() ? kMillimetre : units_[motion]; }

  /// The tool's axis as the pose has it, its turn about that as near as can be to the source's.
  static std::array<double, 3> angles_of(const Pose<double>& pose, const Motion& source) {
    const Matrix3<double> turned =
        Eigen::Quaterniond::FromTwoVectors(source.end.rotation.col(2), pose.rotation.col(2))
            .toRotationMatrix() *
        source.end.rotation;
    const Matrix3<double> down = orientation_by_axis(Vector3<double>::UnitZ());
    return krl_angles(turned * down.transpose());
  }

  std::string axes(const Pose<double>& pose, std::size_t motion) const {
    const double unit = unit_of(motion);
    const int decimals = unit == kInch ? 6 : 4;
    const Vector3<double> place = pose.position / unit;
    std::string text = fmt::format("X{} Y{} Z{}", fixed(place.x(), decimals),
                                   fixed(place.y(), decimals), fixed(place.z(), decimals));
    if (has_angles_) {
      const std::array<double, 3> angles = angles_of(pose, source_.motions[motion]);
      text += fmt::format(" A{} B{} C{}", fixed(angles[2], 6), fixed(angles[1], 6),
                          fixed(angles[0], 6));
    }
    return text;
  }

  /// The motion's lines, without the last one's end.
  std::string lines_of(std::size_t motion, std::string_view end) {
    const Motion& own = source_.motions[motion];
    std::string text;
    visit_in_place(program_, motion, [&](const Pose<double>& start, const Motion& each, bool) {
      const int steps = chords_of(start, each);
      for (int step = 1; step <= steps; ++step) {
        text += text.empty() ? "" : std::string(end);
        text += each.kind == MotionKind::rapid ? "G0 " : "G1 ";
        text += axes(pose_at(start, each, static_cast<double>(step) / steps), motion);
        const bool is_new_feed =
            own.feed > 0 && (own.feed != feed_ || unit_of(motion) != feed_unit_);
        if (is_new_feed && each.kind != MotionKind::rapid) {
          feed_ = own.feed;
          feed_unit_ = unit_of(motion);
          text += fmt::format(" F{}", fixed(60 * feed_ / feed_unit_, 3));
        }
      }
    });
    return text;
  }

  std::string line_in_place(std::size_t motion) {
    const Motion& own = source_.motions[motion];
    std::string line = source_.text.substr(own.begin, own.finish - own.begin);
    std::vector<Word> words;
    read_words(line, &words);
    for (auto word = words.rbegin(); word != words.rend(); ++word) {
      if (is_replaced(*word)) {
        line.erase(word->begin, word->finish - word->begin);
        while (word->begin < line.size() && word->begin > 0 && line[word->begin] == ' ' &&
               line[word->begin - 1] == ' ') {
          line.erase(word->begin, 1);
        }
      }
    }
    line.erase(line.find_last_not_of(" \t\r") + 1);
    const std::string first = line.substr(0, number_end(line));
    const std::string rest = line.substr(first.size());
    // G90 in every line: what stands between may switch to G91.
    std::string moves = lines_of(motion, line_end(source_));
    const std::size_t end_of_first = std::min(moves.find_first_of("\r\n"), moves.size());
    moves.insert(end_of_first, rest.empty() || rest.front() == ' ' ? rest : " " + rest);
    const bool has_return = own.finish > own.begin && source_.text[own.finish - 1] == '\r';
    return first + (first.empty() ? "" : " ") + "G90 " + moves + (has_return ? "\r" : "");
  }

  /// Where the line's number ends, if it begins with one.
  static std::size_t number_end(const std::string& line) {
    std::vector<Word> words;
    read_words(line, &words);
    const bool has_number =
        !words.empty() && words.front().letter == 'N' && words.front().begin <= 1;
    return has_number ? words.front().finish : 0;
  }

  const CorrectedProgram& program_;
  const Program& source_;
  std::vector<double> units_;
  bool has_angles_ = false;
  double feed_ = 0;
  double feed_unit_ = 0;
};

}  // namespace

std::string gcode_text(const CorrectedProgram& program) {
  GcodeWriter writer(program);
  return has_text_in(Format::gcode, program.source) ? writer.rewritten_text() : writer.new_text();
}

}  // namespace flexcomp::programs
