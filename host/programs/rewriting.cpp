#include "programs/rewriting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "files/one_line.hpp"
#include "programs/gcode_statement.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

Vector3<double> direction_at(const Pose<double>& start, const Motion& motion, double from,
                             double to) {
  return pose_at(start, motion, to).position - pose_at(start, motion, from).position;
}

/// Spindle, coolant, comments and the like in a moving line of G-code.
std::string said_beside(const Program& source, const Motion& motion) {
  if (source.format != Format::gcode) {
    return {};
  }
  const std::string_view line =
      std::string_view(source.text).substr(motion.begin, motion.finish - motion.begin);
  return gcode_statement(line, {motion.kind == MotionKind::circular, true}, false).rest;
}

}  // namespace

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_of("123456789") == std::string::npos) {
    text.erase(0, 1);
  }
  return text;
}

bool has_text_in(Format format, const Program& source) {
  return source.format == format && !source.text.empty();
}

std::string origin_of(const CorrectedProgram& program) {
  constexpr std::size_t kLongest = 200;
  return fmt::format("From {}, {} by flexcomp.", files::one_line(program.source.file, kLongest),
                     program.largest_correction > 0 ? "corrected for the deflection of the robot"
                                                    : "written without a correction");
}

std::string rewritten(const Program& source,
                      const std::function<std::string(std::size_t)>& statement) {
  std::vector<std::size_t> as_written(source.motions.size());  // a routine may call one above it
  std::iota(as_written.begin(), as_written.end(), std::size_t{0});
  std::sort(as_written.begin(), as_written.end(), [&](std::size_t a, std::size_t b) {
    return source.motions[a].begin < source.motions[b].begin;
  });
  std::string text;
  text.reserve(source.text.size() * 2);
  std::size_t copied = 0;
  for (const std::size_t i : as_written) {
    const Motion& motion = source.motions[i];
    text.append(source.text, copied, motion.begin - copied);
    text += statement(i);
    copied = motion.finish;
  }
  text.append(source.text, copied, std::string::npos);
  return text;
}

std::string_view line_end(const Program& source) {
  return source.text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

std::string comments_before(const Program& source, std::size_t motion, const std::string& mark) {
  constexpr std::size_t kLongest = 200;  // characters, chosen by judgement: a line to read
  const std::size_t count = source.motions.size();
  const std::size_t first = motion == 0 ? 0 : source.motions[motion - 1].finish;
  const std::size_t last = motion < count ? source.motions[motion].begin : source.text.size();
  std::string comments;
  const std::string_view between =
      std::string_view(source.text).substr(std::min(first, last), last - std::min(first, last));
  for (std::size_t begin = 0; begin < between.size();) {
    const std::string_view line = trimmed_line(next_line(between, &begin));
    if (!line.empty()) {
      comments += mark + files::one_line(line, kLongest) + "\n";
    }
  }
  const std::string beside = motion < count ? said_beside(source, source.motions[motion]) : "";
  if (!beside.empty()) {
    comments += mark + files::one_line(beside, kLongest) + "\n";
  }
  return comments;
}

const Pose<double>& start_of(const CorrectedProgram& program, std::size_t motion) {
  return program.in_place[motion == 0 ? 0 : motion - 1].back().end;
}

void visit_in_place(const CorrectedProgram& program, std::size_t motion,
                    const std::function<void(const Pose<double>&, const Motion&, bool)>& visit) {
  const std::vector<Motion>& motions = program.in_place[motion];
  for (std::size_t i = 0; i < motions.size(); ++i) {
    visit(i == 0 ? start_of(program, motion) : motions[i - 1].end, motions[i],
          i + 1 == motions.size());
  }
}

bool goes_on(const CorrectedProgram& program, std::size_t motion) {
  if (motion == 0 || motion + 1 >= program.in_place.size()) {
    return false;
  }
  const std::vector<Motion>& here = program.in_place[motion];
  const Motion& last = here.back();
  const Motion& next = program.in_place[motion + 1].front();
  if (last.kind == MotionKind::rapid || next.kind == MotionKind::rapid) {
    return false;
  }
  constexpr double kSmall = 1e-3;  // of a motion
  const Pose<double>& start =
      here.size() > 1 ? here[here.size() - 2].end : start_of(program, motion);
  const Vector3<double> in = direction_at(start, last, 1 - kSmall, 1);
  const Vector3<double> out = direction_at(last.end, next, 0, kSmall);
  constexpr double kCosine = 0.985;  // of 10°
  return in.dot(out) >= kCosine * in.norm() * out.norm();
}

int chords_of(const Pose<double>& start, const Motion& motion) {
  if (motion.kind != MotionKind::circular) {
    return 1;
  }
  constexpr double kError = 5e-6;  // m
  constexpr double kMost = 1e6;
  const double radius = (start.position - motion.arc.center).norm();
  const double step = 2 * std::acos(std::max(1 - kError / std::max(radius, kError), 0.0));
  return static_cast<int>(std::ceil(std::min(motion.arc.angle / step, kMost)));
}

}  // namespace flexcomp::programs
