#include "programs/gcode_writer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "programs/gcode_axes.hpp"
#include "programs/gcode_line.hpp"
#include "programs/gcode_modes.hpp"
#include "programs/gcode_statement.hpp"
#include "programs/krl_point.hpp"
#include "programs/rewriting.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

constexpr std::string_view kAngleLetters = "ABC";

/// A number without an exponent, to seven digits, and no zeros behind its last.
std::string plain(double value) {
  const int before = value > 0 ? static_cast<int>(std::floor(std::log10(value))) : 0;
  std::string text = fixed(value, std::clamp(6 - before, 0, 12));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    text.erase(text.find_last_not_of('.') + 1);
  }
  return text;
}

/// A, B and C, degrees.
using GcodeAngles = std::array<double, 3>;

/// The same orientation with each angle as near to another as whole turns bring it.
GcodeAngles unwound(GcodeAngles angles, const GcodeAngles& near) {
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] += 360 * std::round((near[i] - angles[i]) / 360);
  }
  return angles;
}

double farness(const GcodeAngles& angles, const GcodeAngles& from) {
  double sum = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    sum += std::abs(angles[i] - from[i]);
  }
  return sum;
}

/// The nearest of all that are the same orientation: B beyond 90 degrees is one with A and C turned
/// by half a turn.
GcodeAngles nearest(const GcodeAngles& angles, const GcodeAngles& near) {
  const GcodeAngles own = unwound(angles, near);
  const GcodeAngles other = unwound({angles[0] + 180, 180 - angles[1], angles[2] + 180}, near);
  return farness(other, near) < farness(own, near) ? other : own;
}

/// A line in place of a motion, or of a part of it.
struct GcodeStep {
  MotionKind kind = MotionKind::linear;
  Pose<double> end;
  double share = 1;  ///< of the motion's way, or of its turn
};

class GcodeWriter {
 public:
  explicit GcodeWriter(const CorrectedProgram& program)
      : program_(program), source_(program.source) {
    const Matrix3<double> down = orientation_by_axis(Vector3<double>::UnitZ());
    const bool is_tilted = std::any_of(
        source_.motions.begin(), source_.motions.end(),
        [&](const Motion& each) { return (each.end.rotation.col(2) - down.col(2)).norm() > 1e-9; });
    modes_.assign(source_.motions.size(), {});
    if (source_.format == Format::gcode) {
      read_source();
    }
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      angles_[i] = is_tilted || told_.find(kAngleLetters[i]) != std::string::npos;
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
      text += new_lines(i);
    }
    return text + "M2\n";
  }

 private:
  /// The modes that hold in each line that moves, the angles behind it, and the letters of angles
  /// that the program has.
  void read_source() {
    std::vector<Word> words;
    std::size_t motion = 0;
    GcodeModes modes;
    GcodeAxes axes;
    std::size_t number = 0;
    for (std::size_t begin = 0; begin < source_.text.size() && motion < modes_.size();) {
      read_words(next_line(source_.text, &begin), &words);
      ++number;
      modes.read(words);
      for (const Word& word : words) {
        const bool is_angle = kAngleLetters.find(word.letter) != std::string_view::npos;
        told_ += is_angle && told_.find(word.letter) == std::string::npos
                     ? std::string(1, word.letter)
                     : std::string();
      }
      if (!goes_to_machine_place(words)) {
        axes.go(GcodeLine(words), modes);
      }
      if (source_.motions[motion].line == number) {
        const Vector3<double> turn = axes.turn() / kDegree;
        turns_.push_back({turn.x(), turn.y(), turn.z()});
        modes_[motion++] = modes;
      }
    }
  }

  /// The tool's axis as the pose has it, its turn about that as near as can be to the source's.
  static GcodeAngles angles_of(const Pose<double>& pose, const Motion& source) {
    const Matrix3<double> turned =
        Eigen::Quaterniond::FromTwoVectors(source.end.rotation.col(2), pose.rotation.col(2))
            .toRotationMatrix() *
        source.end.rotation;
    const Matrix3<double> down = orientation_by_axis(Vector3<double>::UnitZ());
    const std::array<double, 3> about_zyx = krl_angles(turned * down.transpose());
    return {about_zyx[2], about_zyx[1], about_zyx[0]};
  }

  /// A rotary axis goes from one written angle to the next, the long way round too: the source's
  /// own turns are kept, and a program in another format goes on from the line before.
  std::string axes(const Pose<double>& pose, std::size_t motion) {
    const double unit = modes_[motion].unit;
    const int decimals = unit == kInch ? 6 : 4;
    const Vector3<double> place = pose.position / unit;
    std::string text = fmt::format("X{} Y{} Z{}", fixed(place.x(), decimals),
                                   fixed(place.y(), decimals), fixed(place.z(), decimals));
    const GcodeAngles angles = angles_of(pose, source_.motions[motion]);
    written_ = motion < turns_.size() ? nearest(angles, turns_[motion]) : unwound(angles, written_);
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      if (angles_[i]) {
        text += fmt::format(" {}{}", kAngleLetters[i], fixed(written_[i], 6));
      }
    }
    return text;
  }

  std::vector<GcodeStep> steps_of(std::size_t motion) const {
    const bool is_turn = turns_more(motion);
    std::vector<GcodeStep> steps;
    double whole = 0;
    visit_in_place(program_, motion, [&](const Pose<double>& start, const Motion& each, bool) {
      const int chords = chords_of(start, each);
      Pose<double> from = start;
      for (int chord = 1; chord <= chords; ++chord) {
        const Pose<double> to = pose_at(start, each, static_cast<double>(chord) / chords);
        const double part = is_turn ? turn_between(from.rotation, to.rotation)
                                    : (to.position - from.position).norm();
        steps.push_back({each.kind, to, part});
        whole += part;
        from = to;
      }
    });
    for (GcodeStep& step : steps) {
      constexpr double kLeast = 1e-6;  // each takes some time
      step.share =
          whole > 0 ? std::max(step.share / whole, kLeast) : 1 / static_cast<double>(steps.size());
    }
    return steps;
  }

  /// Does the source's motion turn the tool by more radians than it moves it by metres? What
  /// corrects it is about a millimetre and a milliradian.
  bool turns_more(std::size_t motion) const {
    const Motion& own = source_.motions[motion];
    const Pose<double>& start = source_.motions[motion == 0 ? 0 : motion - 1].end;
    return turn_between(start.rotation, own.end.rotation) > length_of(start, own);
  }

  /// Does the source's motion turn the tool about its tip? Corrected, it moves the tip a little,
  /// and a feed in G94 would be of that little way: G93 gives it its time.
  bool turns_alone(std::size_t motion) const {
    constexpr double kStands = 1e-9;  // m
    const Motion& own = source_.motions[motion];
    return motion > 0 && own.kind != MotionKind::rapid && own.turn_feed > 0 &&
           length_of(source_.motions[motion - 1].end, own) <= kStands;
  }

  /// Of a motion that turns the tool alone, s.
  double seconds_of(std::size_t motion) const {
    const Motion& own = source_.motions[motion];
    const Pose<double>& start = source_.motions[motion - 1].end;
    return turn_between(start.rotation, own.end.rotation) / own.turn_feed;
  }

  static std::string word_of(const GcodeStep& step) {
    return step.kind == MotionKind::rapid ? "G0 " : "G1 ";
  }

  /// A motion of a program in another format.
  std::string new_lines(std::size_t motion) {
    const Motion& own = source_.motions[motion];
    const bool only_turns = turns_alone(motion);
    std::string text = only_turns ? "G93\n" : "";
    for (const GcodeStep& step : steps_of(motion)) {
      text += word_of(step) + axes(step.end, motion);
      if (only_turns) {
        text += " F" + plain(60 / (seconds_of(motion) * step.share));
      } else if (own.feed > 0 && own.feed != feed_ && step.kind != MotionKind::rapid) {
        feed_ = own.feed;
        text += fmt::format(" F{}", fixed(60 * feed_ / kMillimetre, 3));
      }
      text += "\n";
    }
    feed_ = only_turns ? 0 : feed_;
    return text + (only_turns ? "G94\n" : "");
  }

  std::string line_in_place(std::size_t motion) {
    const Motion& own = source_.motions[motion];
    const GcodeModes& modes = modes_[motion];
    const bool is_fed = own.kind != MotionKind::rapid;
    const bool is_turn_by_the_minute = turns_alone(motion) && !modes.is_inverse_time;
    const bool has_own_feed = is_fed && (modes.is_inverse_time || is_turn_by_the_minute);
    const std::vector<GcodeStep> steps = steps_of(motion);
    const std::string_view line =
        std::string_view(source_.text).substr(own.begin, own.finish - own.begin);
    const GcodeStatement statement =
        gcode_statement(line, {own.kind == MotionKind::circular, has_own_feed}, steps.size() > 1);
    const std::string_view end = line_end(source_);
    const std::string mark = statement.is_skippable ? "/" : "";
    const double seconds = is_turn_by_the_minute ? seconds_of(motion)
                           : has_own_feed        ? 60 / modes.feed
                                                 : 0;
    std::string text = statement.prefix;
    text += text.empty() || text == "/" || text == "%" ? "" : " ";
    text += has_own_feed ? "G90 G93 " : "G90 ";  // what stands between may switch to G91
    for (std::size_t i = 0; i < steps.size(); ++i) {
      text += (i == 0 ? "" : std::string(end) + mark) + word_of(steps[i]);
      text += axes(steps[i].end, motion);
      text += has_own_feed ? " F" + plain(60 / (seconds * steps[i].share)) : "";
      text += i == 0 && !statement.rest.empty() ? " " + statement.rest : "";
    }
    text += statement.stops;
    if (is_turn_by_the_minute) {
      text += fmt::format("{}{}G94 F{}", end, mark, plain(modes.feed));
    }
    if (modes.is_relative && has_axes_behind(motion)) {
      text += fmt::format("{}G91", end);
    }
    const bool has_return = own.finish > own.begin && source_.text[own.finish - 1] == '\r';
    return text + (has_return ? "\r" : "");
  }

  /// Do lines that stay as they are have axes, before the next motion? They are meant in the
  /// source's own mode.
  bool has_axes_behind(std::size_t motion) const {
    const std::size_t finish = motion + 1 < source_.motions.size()
                                   ? source_.motions[motion + 1].begin
                                   : source_.text.size();
    const std::string_view behind =
        std::string_view(source_.text)
            .substr(source_.motions[motion].finish, finish - source_.motions[motion].finish);
    std::vector<Word> words;
    for (std::size_t begin = 0; begin < behind.size();) {
      read_words(next_line(behind, &begin), &words);
      if (std::any_of(words.begin(), words.end(), [](const Word& word) {
            return std::string_view("XYZABC").find(word.letter) != std::string_view::npos;
          })) {
        return true;
      }
    }
    return false;
  }

  const CorrectedProgram& program_;
  const Program& source_;
  std::vector<GcodeModes> modes_;   ///< by motion
  std::string told_;                ///< letters of angles that the source has
  std::array<bool, 3> angles_{};    ///< of A, B and C: is it written?
  std::vector<GcodeAngles> turns_;  ///< of the source in G-code, by motion
  GcodeAngles written_{};           ///< in the line before
  double feed_ = 0;
};

}  // namespace

std::string gcode_text(const CorrectedProgram& program) {
  GcodeWriter writer(program);
  return has_text_in(Format::gcode, program.source) ? writer.rewritten_text() : writer.new_text();
}

}  // namespace flexcomp::programs
