#include "programs/krl_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/krl_data.hpp"
#include "programs/krl_settings.hpp"
#include "programs/krl_words.hpp"
#include "programs/nesting.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

constexpr const char* kTurning =
    "a relative motion that turns, or in the tool's frame, is not read";
constexpr const char* kExternal = "an external axis (E1 to E6) that moves is not planned";
constexpr const char* kUnclear =
    "in a branch or a loop: how the motions behind it are made cannot "
    "be told";

class KrlReader {
 public:
  explicit KrlReader(Program* program) : program_(*program) {}

  void read_data(std::string_view text) {
    for (std::size_t begin = 0; begin < text.size();) {
      Scanner scanner(krl_code(next_line(text, &begin)));
      data_.read_declaration(scanner.name(), &scanner);
    }
  }

  void read_source() {
    const std::string_view text = program_.text;
    for (std::size_t begin = 0; begin < text.size();) {
      begin_ = begin;
      const std::string_view code = krl_code(next_line(text, &begin));
      finish_ = begin_ + code.find_last_not_of(" \t\r") + 1;
      ++line_;
      Scanner scanner(code);
      if (!scanner.at_end() && scanner.peek() != '&') {
        read_statement(&scanner);
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { refuse(program_.file, line_, why); }
  void note(const std::string& text) { program_.notes.push_back({line_, text}); }

  void read_statement(Scanner* scanner) {
    const std::string word = scanner->name();
    if (begins_krl_routine(word, *scanner)) {
      nesting_.begin_routine();
    } else if (nesting_.is_over()) {
      pass_what_is_not_run(word);
    } else if (kKrlOpening.count(word) > 0) {
      open_block(word, scanner);
    } else if (kKrlClosing.count(word) > 0) {
      nesting_.close();
    } else if (kKrlLeaving.count(word) > 0) {
      leave(word);
    } else if (kKrlUnreadable.count(word) > 0) {
      fail(fmt::format("'{}': this motion is not read", word));
    } else if (kKrlMotions.count(word) > 0) {
      refuse_hidden();
      read_motion(word, scanner);
    } else if (KrlSettings::is_setting(word, *scanner)) {
      read_setting(word, scanner);
    } else if (word != "BAS" && kKrlWithoutMotion.count(word) == 0) {
      read_other(word, scanner);
    } else if (word == "DECL" || word == "GLOBAL") {
      data_.read_declaration(word, scanner);
    }
  }

  void pass_what_is_not_run(const std::string& word) {
    const bool is_motion = kKrlMotions.count(word) > 0 || kKrlUnreadable.count(word) > 0;
    if (is_motion && line_over_ != 0) {
      note(fmt::format("what stands behind line {} is not run; it is left as it is", line_over_));
      line_over_ = 0;
    }
  }

  /// A block begins with its line; a statement in the same line would be missed.
  void open_block(const std::string& word, Scanner* scanner) {
    if (word == "IF" && has_krl_statement_behind_then(*scanner)) {
      fail("a statement in the line of its IF is not read");
    }
    if (word == "FOR") {
      data_.forget(scanner->name());
    }
    nesting_.open();
  }

  void leave(const std::string& word) {
    const std::string why =
        fmt::format("'{}': whether the motions here are run cannot be told", word);
    if (word == "GOTO" && nesting_.moves_here()) {
      fail(why);
    }
    const bool is_end = word == "RETURN" || word == "END" || word == "ENDFCT";
    if (is_end && !nesting_.is_inside()) {
      nesting_.end_run();
      line_over_ = line_;
    } else if (word != "EXIT" || !nesting_.is_inside()) {  // inside, EXIT leaves a loop alone
      nesting_.doubt(line_, why);
    }
  }

  void read_setting(const std::string& word, Scanner* scanner) {
    if (nesting_.is_inside()) {
      nesting_.doubt(line_, fmt::format("'{}' {}", word, kUnclear));
    } else if (nesting_.moves_elsewhere()) {
      fail(fmt::format("'{}' in a second routine: when it is called cannot be told", word));
    } else if (word == "BAS") {
      settings_.call_bas(line_, scanner);
    } else {
      scanner->take('=');
      settings_.assign(word, line_, scanner);
    }
  }

  void read_other(const std::string& word, Scanner* scanner) {
    if (data_.read_declaration(word, scanner)) {
      forget_in_branch(word);
      return;
    }
    const bool is_element = scanner->peek() == '[';
    if (!is_element && scanner->take('=')) {
      data_.assign(word, scanner);
      forget_in_branch(word);
    } else if (!is_element && scanner->take(':') && scanner->at_end()) {
      return;  // a label
    } else if (!is_element || word.empty()) {
      note(fmt::format("'{}' is unknown; if it moves the robot, its way is missing",
                       files::one_line(word.empty() ? scanner->rest() : word, 30)));
    }
  }

  void forget_in_branch(const std::string& word) {
    if (nesting_.is_inside()) {
      data_.forget(word);
    }
  }

  /// The point that a motion goes to; nothing where no file tells it. `name` is as it is written.
  std::optional<KrlPoint> read_target(Scanner* scanner, std::string* name) {
    const KrlReadPoint read = data_.read_point(scanner);
    if (!read.why.empty()) {
      fail(read.why);
    }
    *name = read.name;
    return read.point;
  }

  KrlPoint whole(KrlPoint point) const {
    point.fill_from(at_);
    if (!point.is_whole()) {
      fail("the point lacks some of X, Y, Z, A, B and C, and no point before it tells them");
    }
    return point;
  }

  /// The first routine is run alone. Another is run where it is called, maybe in a loop or never,
  /// with what is set until there.
  void refuse_hidden() {
    if (!nesting_.is_in_first_routine()) {
      fail(kInSecondRoutine);
    }
    if (const char* why = nesting_.why_no_motion()) {
      fail(why);
    }
    if (nesting_.doubt()) {
      refuse(program_.file, nesting_.doubt()->line, nesting_.doubt()->why);
    }
  }

  /// A place that is not Cartesian, or not known: nothing is planned, and what is not said of the
  /// next point cannot be filled in.
  void leave_out(const std::string& why) {
    note(why);
    at_ = {};
    is_lost_ = true;
  }

  void read_motion(const std::string& word, Scanner* scanner) {
    if (word == "PTP" || word == "SPTP") {
      read_rapid(scanner);
    } else if (word == "CIRC" || word == "SCIRC") {
      read_circular(scanner);
    } else {
      read_linear(word, scanner);
    }
  }

  void read_rapid(Scanner* scanner) {
    std::string name;
    const std::optional<KrlPoint> point = read_target(scanner, &name);
    if (!point) {
      leave_out(fmt::format("'{}': no file tells this point; the motion is left as it is",
                            files::one_line(name, 30)));
    } else if (point->has_axes) {
      meet_external(*point);
      leave_out("a point in joint angles; the motion is left as it is");
    } else {
      const KrlPoint target = whole(*point);
      add(MotionKind::rapid, target, {}, read_tail(false, scanner));
    }
  }

  KrlPoint read_known_target(Scanner* scanner) {
    std::string name;
    const std::optional<KrlPoint> point = read_target(scanner, &name);
    if (!point || point->has_axes) {
      fail(fmt::format("'{}': no file tells this point", files::one_line(name, 30)));
    }
    return *point;
  }

  void read_linear(const std::string& word, Scanner* scanner) {
    const bool is_relative = word == "LIN_REL" || word == "SLIN_REL";
    KrlPoint point = read_known_target(scanner);
    if (is_relative) {
      point = moved_by(point);
    }
    const KrlState state = read_tail(is_relative, scanner);
    add(is_lost_ ? MotionKind::rapid : MotionKind::linear, whole(point), {}, state);
  }

  KrlPoint moved_by(KrlPoint point) const {
    if (point.frame[3] || point.frame[4] || point.frame[5]) {
      fail(kTurning);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (point.frame[i] && at_.frame[i]) {
        *point.frame[i] += *at_.frame[i];
      }
    }
    for (std::optional<double>& each : point.external) {
      if (each && *each != 0) {
        fail(kExternal);
      }
      each.reset();
    }
    return point;
  }

  /// What stands behind the points: how they are passed, and what the motion sets for itself.
  KrlState read_tail(bool is_relative, Scanner* scanner) {
    KrlState state = settings_.state();
    while (!scanner->at_end()) {
      const std::size_t begin = scanner->place();
      const bool is_frame = is_relative && scanner->take('#');
      const std::string word = scanner->name();
      if (is_frame && word == "TOOL") {
        fail(kTurning);
      }
      if (word == "WITH") {
        state = settings_.with(line_, scanner);
      } else if (is_frame ? word != "BASE" : kKrlPassing.count(word) == 0) {
        scanner->go_to(begin);
        fail(
            fmt::format("'{}' behind the point is not read", files::one_line(scanner->rest(), 30)));
      }
    }
    return state;
  }

  void read_circular(Scanner* scanner) {
    if (is_lost_ || program_.motions.empty()) {
      fail("a circle from a point that no file tells");
    }
    KrlPoint between = read_known_target(scanner);
    if (!scanner->take(',')) {
      fail("expected a comma and the circle's end");
    }
    const KrlPoint end = whole(read_known_target(scanner));
    between.fill_from(at_);
    double angle = 0;
    if (scanner->take(',')) {
      const double given = scanner->name() == "CA" ? scanner->number().value_or(0) : 0;
      constexpr double kMost = 36000;
      if (given == 0 || std::abs(given) > kMost) {
        fail("expected CA and the circle's angle, degrees, of up to a hundred turns");
      }
      angle = given * kDegree;
    }
    const KrlState state = read_tail(false, scanner);
    const Vector3<double> from = program_.motions.back().end.position;
    KrlPoint on_the_way = between;
    on_the_way.fill_from(end);
    const std::optional<Arc> arc =
        arc_through(from, on_the_way.pose().position, end.pose().position);
    if (!arc) {
      fail("start, point between and end of the circle lie on a line");
    }
    add(MotionKind::circular, end, *arc, state, angle);
  }

  /// An external axis turns or carries the work or the robot: one that moves is not planned.
  void meet_external(const KrlPoint& point) {
    std::array<std::optional<double>, 6>& external = program_.external;
    for (std::size_t i = 0; i < external.size(); ++i) {
      const std::optional<double>& to = point.external[i];
      const double from = external[i].value_or(program_.motions.empty() ? to.value_or(0) : 0);
      if (to && *to != from) {
        fail(kExternal);
      }
      external[i] = to ? to : external[i];
    }
  }

  void meet_posture(const KrlPoint& point) {
    if (point.has_posture && !has_told_of_posture_) {
      note("the posture that S and T give is not used: plan chooses one by itself");
      has_told_of_posture_ = true;
    }
  }

  void add(MotionKind kind, const KrlPoint& point, const Arc& arc, const KrlState& state,
           double angle = 0) {
    meet_external(point);
    meet_posture(point);
    settings_.meet(state, line_);
    Motion motion;
    motion.kind = kind;
    motion.end = point.pose();
    motion.has_known_start = !is_lost_ || program_.motions.empty();
    motion.arc = arc;
    if (angle != 0) {
      go_round(program_.motions.back().end, angle, &motion);
    }
    motion.feed = kind == MotionKind::rapid ? 0 : state.override * state.feed;
    motion.turn_feed = kind == MotionKind::rapid ? 0 : state.override * state.turn_feed();
    motion.is_cutting = kind != MotionKind::rapid;
    motion.line = line_;
    motion.begin = begin_;
    motion.finish = finish_;
    if (!motion.has_known_start) {
      note(fmt::format(
          "the place before is not told; the way here from line {} is planned as straight",
          program_.motions.back().line));
    }
    append(motion, &program_);
    at_ = point;
    if (angle != 0) {
      for (std::size_t i = 0; i < 3; ++i) {
        at_.frame[i] = 1e3 * motion.end.position[static_cast<Eigen::Index>(i)];
      }
    }
    is_lost_ = false;
  }

  Program& program_;
  KrlData data_;
  KrlSettings settings_{&program_, &data_};
  KrlPoint at_;
  bool has_told_of_posture_ = false;
  bool is_lost_ = true;
  std::size_t line_over_ = 0;  ///< behind which nothing is run; zero where it is told already
  Nesting nesting_;
  std::size_t line_ = 0;
  std::size_t begin_ = 0;
  std::size_t finish_ = 0;
};

}  // namespace

Program krl_program(const std::string& file, std::string src, const std::string& dat) {
  Program program = unread(Format::krl, file, std::move(src));
  KrlReader reader(&program);
  reader.read_data(dat);
  reader.read_source();
  return program;
}

Program read_krl(const std::filesystem::path& file) {
  std::string src = files::read_text(file);
  std::string data;
  for (const char* ending : {".dat", ".DAT", ".Dat"}) {
    std::filesystem::path beside = file;
    beside.replace_extension(ending);
    std::error_code error;
    if (std::filesystem::exists(beside, error)) {
      data = files::read_text(beside);
      break;
    }
  }
  return krl_program(file.string(), std::move(src), data);
}

}  // namespace flexcomp::programs
