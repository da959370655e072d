#include "programs/rapid_writer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "files/one_line.hpp"
#include "programs/rapid_statements.hpp"
#include "programs/rapid_values.hpp"
#include "programs/rewriting.hpp"

namespace flexcomp::programs {
namespace {

constexpr const char* kNoConfiguration = ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]";

std::string rapid_pose(const Pose<double>& pose) {
  Eigen::Quaterniond q(pose.rotation);
  if (q.w() < 0) {
    q.coeffs() = -q.coeffs();
  }
  const Vector3<double> place = pose.position / kMillimetre;
  return fmt::format("[{},{},{}],[{},{},{},{}]", fixed(place.x(), 4), fixed(place.y(), 4),
                     fixed(place.z(), 4), fixed(q.w(), 9), fixed(q.x(), 9), fixed(q.y(), 9),
                     fixed(q.z(), 9));
}

std::string target(const Pose<double>& pose, const std::string& configuration) {
  return fmt::format("[{}{}]", rapid_pose(pose), configuration);
}

/// The targets of a motion: for an arc the pose halfway before its end.
std::string targets(const Pose<double>& shift, const Pose<double>& start, const Motion& motion,
                    const std::string& configuration) {
  std::string text;
  if (motion.kind == MotionKind::circular) {
    text = target(shift * pose_at(start, motion, 0.5), configuration) + ",";
  }
  return text + target(shift * motion.end, configuration);
}

const char* word_for(MotionKind kind) {
  switch (kind) {
    case MotionKind::rapid:
      return "MoveJ";
    case MotionKind::circular:
      return "MoveC";
    case MotionKind::linear:
      break;
  }
  return "MoveL";
}

/// Where the next comma stands that is in no bracket; the end if there is none.
std::size_t next_comma(std::string_view text, std::size_t from) {
  int depth = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    depth += text[i] == '[' || text[i] == '(' ? 1 : 0;
    depth -= text[i] == ']' || text[i] == ')' ? 1 : 0;
    if (text[i] == ',' && depth == 0) {
      return i;
    }
  }
  return text.size();
}

/// A motion's statement in the source, taken to pieces.
struct RapidMove {
  std::string head;           ///< "\Conc,"
  std::string configuration;  ///< of its end
  std::string speed;          ///< ",v100"
  std::string zone;           ///< ",z1"
  std::string tail;           ///< ",tool0\WObj:=wobj0"
};

class Rewriter {
 public:
  explicit Rewriter(const CorrectedProgram& program) : program_(program) {
    const std::optional<Pose<double>>& own = program.source.frame;
    if (own) {  // the module's work object stays: the points are moved in it
      shift_ = inverse(*own) * program.frame;
    }
    data_.read_all(program.source.text);
  }

  std::string statement(std::size_t motion) const {
    const Motion& own = program_.source.motions[motion];
    RapidStatement source;
    RapidStatements(
        std::string_view(program_.source.text).substr(own.begin, own.finish - own.begin))
        .next(&source);
    const RapidMove move = taken_apart(source.text);
    const std::string indent = indent_before(own.begin);
    const std::size_t parts = program_.in_place[motion].size();
    double way = 0;
    visit_in_place(program_, motion, [&](const Pose<double>& start, const Motion& each, bool) {
      way += way_of(start, each);
    });
    std::string text;
    visit_in_place(
        program_, motion, [&](const Pose<double>& start, const Motion& each, bool is_last) {
          const double share = way > 0 ? way_of(start, each) / way : 1 / static_cast<double>(parts);
          const std::string speed = parts > 1 ? with_time_of(move.speed, share) : move.speed;
          text += fmt::format("{}{} {}{}{}{};{}", word_for(each.kind), is_last ? move.head : "",
                              targets(shift_, start, each, move.configuration), speed,
                              is_last ? move.zone : ",z0", move.tail,
                              is_last ? "" : line_end(program_.source));
          text += is_last ? "" : indent;
        });
    return text;
  }

 private:
  RapidMove taken_apart(std::string_view text) const {
    RapidMove move;
    Scanner scanner(text);
    const bool is_circle = scanner.name() == "MOVEC";
    std::size_t begin = scanner.place();
    if (scanner.peek() == '\\') {
      const std::size_t comma = next_comma(text, begin);
      move.head = files::one_line(text.substr(begin, comma - begin), 200) + ",";
      begin = comma + 1;
    }
    std::size_t end = next_comma(text, begin);
    if (is_circle) {
      begin = end + 1;
      end = next_comma(text, begin);
    }
    move.configuration = configuration_of(text.substr(begin, end - begin));
    const std::size_t zone = next_comma(text, end + 1);
    const std::size_t tool = next_comma(text, zone + 1);
    move.speed = files::one_line(text.substr(end, zone - end), 200);
    move.zone = files::one_line(text.substr(zone, tool - zone), 200);
    move.tail = files::one_line(text.substr(tool), 200);
    return move;
  }

  /// A part of a motion takes its share of the time (\\T) that the whole one is given.
  std::string with_time_of(const std::string& speed, double share) const {
    for (std::size_t at = speed.find('\\'); at != std::string::npos;
         at = speed.find('\\', at + 1)) {
      Scanner scanner(std::string_view(speed).substr(at + 1));
      if (scanner.name() != "T" || !scanner.take(':') || !scanner.take('=')) {
        continue;
      }
      if (const std::optional<double> time = data_.number(&scanner)) {
        return fmt::format("{}T:={:.6g}{}", speed.substr(0, at + 1), share * *time, scanner.rest());
      }
    }
    return speed;
  }

  std::string configuration_of(std::string_view target_text) const {
    Scanner scanner(target_text);
    if (scanner.peek() == '[') {
      return rapid_configuration(target_text);
    }
    std::optional<std::string> name = data_.target_name(&scanner);
    while ((name == "OFFS" || name == "RELTOOL") && scanner.take('(')) {
      name = data_.target_name(&scanner);
    }
    const auto found = data_.configurations.find(name.value_or(""));
    return found == data_.configurations.end() ? kNoConfiguration : found->second;
  }

  std::string indent_before(std::size_t begin) const {
    const std::string& text = program_.source.text;
    const std::size_t line = begin == 0 ? 0 : text.rfind('\n', begin - 1) + 1;
    const std::string before = text.substr(line, begin - line);
    return before.find_first_not_of(" \t") == std::string::npos ? before : "";
  }

  const CorrectedProgram& program_;
  Pose<double> shift_;
  RapidData data_;
};

/// Speeddata: by name where the source does not say.
std::string speed_of(const Motion& motion) {
  if (motion.kind == MotionKind::rapid) {
    return "v500";
  }
  if (!(motion.feed > 0) && !(motion.turn_feed > 0)) {
    return "v50";
  }
  return fmt::format("[{:.6g},{:.6g},5000,1000]", motion.feed > 0 ? motion.feed / kMillimetre : 50,
                     motion.turn_feed > 0 ? motion.turn_feed / kDegree : 500);
}

/// The tool's name is declared nowhere: with tool0, which every controller has and which is the
/// bare flange, the robot would drive its flange to the cut.
std::string tool_to_declare(const CorrectedProgram& program, const std::string& name) {
  std::string text = fmt::format(
      "! The points are of the TCP of the robot's model. Declare {}_tool with that TCP and its "
      "load.\n",
      name);
  if (const std::optional<CarriedTool>& tool = program.tool) {
    const Vector3<double> center = tool->center / kMillimetre;
    const std::string load =
        tool->mass > 0 ? fmt::format("{:.6g},[{},{},{}]", tool->mass, fixed(center.x(), 4),
                                     fixed(center.y(), 4), fixed(center.z(), 4))
                       : "<mass in kg>,[<its center in mm>]";
    text += fmt::format(
        "! As the model has it, if its last link is the robot's tool0:\n"
        "! PERS tooldata {}_tool:=[TRUE,[{}],[{},[1,0,0,0],0,0,0]];\n",
        name, rapid_pose(tool->tcp), load);
  }
  return text;
}

std::string new_module(const CorrectedProgram& program, const std::string& name) {
  const Program& source = program.source;
  std::string text = fmt::format(
      "MODULE {0}\n! {1}\n{3}"
      "PERS wobjdata {0}_work:=[FALSE,TRUE,\"\",[{2}],[[0,0,0],[1,0,0,0]]];\nPROC {0}_run()\n",
      name, origin_of(program), rapid_pose(program.frame), tool_to_declare(program, name));
  for (std::size_t i = 0; i < source.motions.size(); ++i) {
    text += comments_before(source, i, "  ! ");
    if (i > 0 && !source.motions[i].has_known_start) {
      text += fmt::format("  Stop; ! {}\n", kUnknownWay);
    }
    const std::string speed = speed_of(source.motions[i]);
    const bool goes_on_after = goes_on(program, i);
    visit_in_place(program, i, [&](const Pose<double>& start, const Motion& each, bool is_last) {
      text += fmt::format("  {0} {1},{2},{3},{4}_tool\\WObj:={4}_work;\n", word_for(each.kind),
                          targets({}, start, each, kNoConfiguration), speed,
                          !is_last || goes_on_after ? "z0" : "fine", name);
    });
  }
  text += comments_before(source, source.motions.size(), "  ! ");
  return text + "ENDPROC\nENDMODULE\n";
}

}  // namespace

std::string rapid_text(const CorrectedProgram& program, const std::string& name) {
  if (!has_text_in(Format::rapid, program.source)) {
    return new_module(program, name);
  }
  const Rewriter rewriter(program);
  return rewritten(program.source, [&](std::size_t motion) { return rewriter.statement(motion); });
}

}  // namespace flexcomp::programs
