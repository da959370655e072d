#include "programs/krl_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/one_line.hpp"
#include "programs/krl_data.hpp"
#include "programs/krl_words.hpp"
#include "programs/rewriting.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

std::string krl_place(const Vector3<double>& place) {
  return fmt::format("X {},Y {},Z {}", fixed(place.x() / kMillimetre, 4),
                     fixed(place.y() / kMillimetre, 4), fixed(place.z() / kMillimetre, 4));
}

/// A point; `others` are components such as S 2,T 35.
std::string krl_pose(const Pose<double>& pose, const std::string& others = {}) {
  const std::array<double, 3> angles = krl_angles(pose.rotation);
  return fmt::format("{{{},A {},B {},C {}{}{}}}", krl_place(pose.position), fixed(angles[0], 6),
                     fixed(angles[1], 6), fixed(angles[2], 6), others.empty() ? "" : ",", others);
}

/// The motion's target in a frame that `shift` leads to, for an arc the point halfway before it.
std::string krl_target(const Pose<double>& shift, const Pose<double>& start, const Motion& motion,
                       const std::string& others = {}) {
  const std::string end = krl_pose(shift * motion.end, others);
  return motion.kind == MotionKind::circular
             ? fmt::format("{{{}}},{}", krl_place((shift * pose_at(start, motion, 0.5)).position),
                           end)
             : end;
}

/// A motion's statement in the source, taken to pieces.
struct KrlStatement {
  std::string indent;
  std::string word;    ///< as LIN_REL, in capitals
  std::string others;  ///< components of the target beside X to C
  std::string tail;    ///< behind the target
};

/// Where the external axes stand, as components.
std::string external_components(const Program& source) {
  std::string components;
  for (std::size_t i = 0; i < source.external.size(); ++i) {
    if (source.external[i]) {
      components +=
          fmt::format("{}E{} {:.10g}", components.empty() ? "" : ",", i + 1, *source.external[i]);
    }
  }
  return components;
}

/// The components of a target that are none of X to C: of an aggregate as they stand, of a name the
/// external axes.
std::string other_components(const Program& source, std::string_view aggregate) {
  std::string others;
  const std::size_t open = aggregate.find('{');
  if (open == std::string_view::npos) {
    return external_components(source);
  }
  std::string_view inside = aggregate.substr(open + 1, aggregate.size() - open - 2);
  const std::size_t type = inside.find(':');
  inside.remove_prefix(type == std::string_view::npos ? 0 : type + 1);
  for (std::size_t begin = 0; begin < inside.size();) {
    const std::size_t end = std::min(inside.find(',', begin), inside.size());
    const std::string_view component = inside.substr(begin, end - begin);
    begin = end + 1;
    Scanner scanner(component);
    const std::string name = scanner.name();
    if (name.size() == 1 && std::string_view("XYZABC").find(name[0]) != std::string_view::npos) {
      continue;
    }
    others += (others.empty() ? "" : ",") + files::one_line(component);
  }
  return others;
}

/// Passes over a point, and hands it out as it stands; of a product (P1:P2) its last operand.
std::string_view pass_target(std::string_view statement, Scanner* scanner) {
  std::size_t begin = 0;
  std::size_t end = 0;  // before the blanks that looking for a colon passes over
  do {
    const bool is_aggregate = scanner->peek() == '{';
    begin = scanner->place();
    if (is_aggregate) {
      scanner->go_to(std::min(statement.find('}', begin), statement.size() - 1) + 1);
    } else {
      krl_indexed_name(scanner->name(), scanner);
    }
    end = scanner->place();
  } while (scanner->take(':'));
  return statement.substr(begin, end - begin);
}

/// Does the target say how far to go? It is written as a place, to which neither what else it tells
/// nor the frame that it counts in belongs.
bool is_relative(const std::string& word) {
  constexpr std::string_view kEnding = "_REL";
  return word.size() > kEnding.size() &&
         word.compare(word.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

/// What stands behind a relative target, without #BASE.
std::string without_frame(std::string tail) {
  Scanner scanner(tail);
  while (!scanner.at_end()) {
    const std::size_t begin = scanner.place();
    if (scanner.take('#')) {
      scanner.name();
      scanner.peek();
      return tail.erase(begin, scanner.place() - begin);
    }
    if (kKrlPassing.count(scanner.name()) == 0) {
      break;
    }
  }
  return tail;
}

KrlStatement taken_apart(const Program& source, std::string_view statement) {
  KrlStatement parts;
  Scanner scanner(statement);
  scanner.peek();
  parts.indent = statement.substr(0, scanner.place());
  parts.word = scanner.name();
  parts.others = other_components(source, pass_target(statement, &scanner));
  while (scanner.take(',')) {  // the end of a circle, and its angle
    if (scanner.peek() != '{' && Scanner(scanner.rest()).name() == "CA") {
      scanner.name();
      scanner.number();
    } else {
      parts.others = other_components(source, pass_target(statement, &scanner));
    }
  }
  parts.tail = files::one_line(scanner.rest(), 1000);
  if (is_relative(parts.word)) {
    parts.others.clear();
    parts.tail = without_frame(std::move(parts.tail));
  }
  parts.tail.erase(parts.tail.find_last_not_of(' ') + 1);
  return parts;
}

/// The word for a motion in place of one in the source: spline forms stay spline forms.
std::string word_for(const std::string& word, MotionKind kind) {
  const std::string spline = word.front() == 'S' ? "S" : "";
  return spline + (kind == MotionKind::rapid ? "PTP" : kind == MotionKind::linear ? "LIN" : "CIRC");
}

/// How a point is passed without a stop.
const char* passing(MotionKind kind) { return kind == MotionKind::rapid ? "C_PTP" : "C_DIS"; }

/// Added points are passed without a stop, at the motion's own speed where it has one.
std::string tail_of_added(const std::string& tail, MotionKind kind) {
  return tail.find("WITH") == std::string::npos ? passing(kind)
                                                : tail.substr(0, tail.find(" C_")) + " C_DIS";
}

bool is_frame_of_source(const CorrectedProgram& program) {
  constexpr double kSame = 1e-8;  // m, rad
  const std::optional<Pose<double>>& own = program.source.frame;
  return own && (own->position - program.frame.position).norm() < kSame &&
         (own->rotation - program.frame.rotation).norm() < kSame;
}

/// From the frame that the motions are in to the one that their points are written in: a base that
/// the program loads stays, and the points are moved in it.
Pose<double> shift_of(const CorrectedProgram& program) {
  const std::optional<Pose<double>>& own = program.source.frame;
  if (!program.source.loads_frame || !own || is_frame_of_source(program)) {
    return {};
  }
  return inverse(*own) * program.frame;
}

/// What stands before the first motion. A base that the program loads and no file tells cannot be
/// written: loading it again would undo that, and one that was guessed would be driven to.
std::string before_first(const CorrectedProgram& program, const std::string& indent) {
  const Program& source = program.source;
  const std::string frame = krl_pose(program.frame);
  if (source.loads_frame) {
    return source.frame ? ""
                        : fmt::format("{}; the points below are corrected for a base at {}{}",
                                      indent, frame, line_end(source));
  }
  return is_frame_of_source(program) ? ""
                                     : fmt::format("{}$BASE={} ; work frame of the points below{}",
                                                   indent, frame, line_end(source));
}

std::string statement_in_place(const CorrectedProgram& program, std::size_t motion) {
  const Program& source = program.source;
  const Motion& own = source.motions[motion];
  const std::string_view end = line_end(source);
  const KrlStatement parts =
      taken_apart(source, std::string_view(source.text).substr(own.begin, own.finish - own.begin));
  const Pose<double> shift = shift_of(program);
  std::string text = motion == 0 ? before_first(program, parts.indent) : "";
  visit_in_place(program, motion, [&](const Pose<double>& start, const Motion& each, bool is_last) {
    const std::string tail = is_last ? parts.tail : tail_of_added(parts.tail, each.kind);
    text += fmt::format("{}{} {}{}{}{}", parts.indent, word_for(parts.word, each.kind),
                        krl_target(shift, start, each, is_last ? parts.others : ""),
                        tail.empty() ? "" : " ", tail, is_last ? "" : end);
  });
  return text;
}

/// mm, as ABB's z0. A corner of 10°, the sharpest that is passed without a stop, loses 0.013 mm.
constexpr double kNearness = 0.3;

std::string new_program(const CorrectedProgram& program, const std::string& name) {
  const Program& source = program.source;
  std::string text = fmt::format(
      "&ACCESS RVP\nDEF {} ( )\n; {}\n"
      "; The points are of the TCP of the robot's model; $TOOL and load data must be the same.\n"
      "; Come to the first point by a PTP of your own, with S and T or by the axes' angles.\n"
      "$BASE={}\n$APO.CDIS={} ; mm, approximation distance of C_DIS points\n",
      name, origin_of(program), krl_pose(program.frame), kNearness);
  double feed = 0;
  double turn_feed = 0;
  for (std::size_t i = 0; i < source.motions.size(); ++i) {
    text += comments_before(source, i, "; ");
    const Motion& own = source.motions[i];
    if (i > 0 && !own.has_known_start) {
      text += fmt::format("HALT ; {}\n", kUnknownWay);
    }
    if (own.kind != MotionKind::rapid && own.turn_feed != turn_feed) {
      turn_feed = own.turn_feed;
      text += turn_feed > 0
                  ? fmt::format("$VEL.ORI1={0:.6g}\n$VEL.ORI2={0:.6g}\n", turn_feed / kDegree)
                  : std::string("$VEL.ORI1=$VEL_MA.ORI1\n$VEL.ORI2=$VEL_MA.ORI2\n");
    }
    if (own.feed > 0 && own.feed != feed) {
      feed = own.feed;
      text += fmt::format("$VEL.CP={:.6g}\n", feed);
    }
    const bool goes_on_after = goes_on(program, i);
    visit_in_place(program, i, [&](const Pose<double>& start, const Motion& each, bool is_last) {
      const bool stops = is_last && !goes_on_after;
      text += fmt::format("{} {}{}{}\n", word_for("LIN", each.kind), krl_target({}, start, each),
                          stops ? "" : " ", stops ? "" : passing(each.kind));
    });
  }
  text += comments_before(source, source.motions.size(), "; ");
  return text + "END\n";
}

}  // namespace

std::string krl_text(const CorrectedProgram& program, const std::string& name) {
  if (!has_text_in(Format::krl, program.source)) {
    return new_program(program, name);
  }
  return rewritten(program.source,
                   [&](std::size_t motion) { return statement_in_place(program, motion); });
}

}  // namespace flexcomp::programs
