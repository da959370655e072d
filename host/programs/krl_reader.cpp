#include "programs/krl_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/krl_point.hpp"
#include "programs/nesting.hpp"
#include "programs/scanner.hpp"

namespace flexcomp::programs {
namespace {

const std::set<std::string> kKrlOpening = {"IF", "FOR", "WHILE", "REPEAT", "LOOP", "SWITCH"};
const std::set<std::string> kKrlClosing = {"ENDIF", "ENDFOR",  "ENDWHILE",
                                           "UNTIL", "ENDLOOP", "ENDSWITCH"};
const std::set<std::string> kKrlUnreadable = {"SPL",      "SPLINE",    "PTP_SPLINE", "SPL_REL",
                                              "CIRC_REL", "SCIRC_REL", "PTP_REL",    "SPTP_REL"};
const std::set<std::string> kKrlWithoutMotion = {
    "END",    "DEFDAT", "ENDDAT", "EXT",    "EXTFCT", "INI",       "INTERRUPT", "GLOBAL",
    "INT",    "SIGNAL", "ENUM",   "STRUC",  "WAIT",   "HALT",      "PULSE",     "TRIGGER",
    "REAL",   "BOOL",   "CHAR",   "ELSE",   "CASE",   "DEFAULT",   "CONTINUE",  "RETURN",
    "ENDFCT", "EXIT",   "GOTO",   "IMPORT", "ANOUT",  "ANIN",      "DIGIN",     "CCLOSE",
    "COPEN",  "CWRITE", "CREAD",  "SREAD",  "SWRITE", "ENDSPLINE", "DECL",      "BRAKE"};
const std::set<std::string> kKrlPointTypes = {"E6POS", "POS", "FRAME", "E6AXIS", "AXIS"};

class KrlReader {
 public:
  explicit KrlReader(Program* program) : program_(*program) {}

  void read_data(std::string_view text) {
    for (std::size_t begin = 0; begin < text.size();) {
      Scanner scanner(krl_code(next_line(text, &begin)));
      read_declaration(scanner.name(), &scanner);
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
    if (word == "DEF" || word == "DEFFCT") {
      nesting_.begin_routine();
    } else if (kKrlOpening.count(word) > 0) {
      nesting_.open();
    } else if (kKrlClosing.count(word) > 0) {
      nesting_.close();
    } else if (kKrlUnreadable.count(word) > 0) {
      fail(fmt::format("'{}': this motion is not read", word));
    } else if (word == "LIN" || word == "SLIN" || word == "LIN_REL" || word == "SLIN_REL") {
      read_linear(word, scanner);
    } else if (word == "PTP" || word == "SPTP") {
      read_rapid(scanner);
    } else if (word == "CIRC" || word == "SCIRC") {
      read_circular(scanner);
    } else if (word == "BAS") {
      read_call_of_bas(scanner);
    } else if (!read_declaration(word, scanner) && kKrlWithoutMotion.count(word) == 0) {
      read_assignment(word, scanner);
    }
  }

  /// DECL E6POS P1={…}; true for a declaration.
  bool read_declaration(std::string word, Scanner* scanner) {
    const bool is_declared = word == "DECL" || word == "GLOBAL";
    while (word == "DECL" || word == "GLOBAL" || word == "CONST") {
      word = scanner->name();
    }
    if (kKrlPointTypes.count(word) == 0) {
      return is_declared;
    }
    do {
      const std::string name = scanner->name();
      if (scanner->take('=')) {
        const std::optional<KrlPoint> point = read_krl_point(scanner);
        if (point) {
          points_[name] = *point;
        }
      }
    } while (scanner->take(','));
    return true;
  }

  void read_assignment(const std::string& word, Scanner* scanner) {
    const bool is_element = scanner->peek() == '[';
    if (!is_element && scanner->take('=')) {
      assign(word, scanner);
    } else if (!is_element || word.empty()) {
      note(fmt::format("'{}' is unknown; if it moves the robot, its way is missing",
                       files::one_line(word.empty() ? scanner->rest() : word, 30)));
    }
  }

  void assign(const std::string& name, Scanner* scanner) {
    if (name == "$VEL.CP") {
      set_feed(scanner->number());
    } else if (name == "$VEL") {
      const std::size_t at = scanner->rest().find("CP");
      if (at != std::string_view::npos) {
        scanner->go_to(scanner->place() + at + 2);
        set_feed(scanner->number());
      }
    } else if (name == "$BASE") {
      set_frame(scanner);
    } else if (name == "$TOOL") {
      note("'$TOOL': the robot's own tool is used; the two must be the same");
    } else if (const std::optional<KrlPoint> point = read_krl_point(scanner)) {
      points_[name] = *point;
    } else {
      points_.erase(name.substr(0, name.find('.')));  // computed: nobody knows it now
    }
  }

  void set_feed(const std::optional<double>& feed) { feed_ = known_feed(feed).value_or(feed_); }

  /// A feed, m/s, where it is one.
  std::optional<double> known_feed(const std::optional<double>& feed) {
    if (feed && *feed > 0) {
      return feed;
    }
    note("the feed is not a number above zero here; that before it is used");
    return std::nullopt;
  }

  void set_frame(Scanner* scanner) {
    std::optional<KrlPoint> point = read_krl_point(scanner);
    std::string name;
    if (!point) {
      name = scanner->name();
      if (name == "$NULLFRAME") {
        point = KrlPoint{{0, 0, 0, 0, 0, 0}, false};
      } else if (points_.count(name) > 0 && scanner->at_end()) {
        point = points_.at(name);
      }
    }
    if (!point || !point->is_whole()) {
      note(
          fmt::format("'$BASE': {} is not in the file; without --frame the work is put where the "
                      "robot reaches it",
                      files::one_line(name.empty() ? "its value" : name, 30)));
      return;
    }
    const Pose<double> frame = point->pose();
    if (program_.frame && !program_.motions.empty() &&
        (program_.frame->position != frame.position ||
         program_.frame->rotation != frame.rotation)) {
      fail("a second $BASE; one work frame is planned at a time");
    }
    program_.frame = frame;
  }

  void read_call_of_bas(Scanner* scanner) {
    scanner->take('(');
    scanner->take('#');
    const std::string what = scanner->name();
    if ((what == "VEL_CP" || what == "CP_PARAMS") && scanner->take(',')) {
      set_feed(scanner->number());
    }
  }

  /// The point that a motion goes to; nothing where no file tells it. `name` is as it is written.
  std::optional<KrlPoint> read_target(Scanner* scanner, std::string* name) {
    std::optional<KrlPoint> point;
    if (scanner->peek() == '{') {
      point = read_krl_point(scanner);
      if (!point) {
        fail("expected a point such as {X 1, Y 2, Z 3, A 0, B 0, C 0}");
      }
    } else {
      *name = scanner->name();
      for (const std::string& each : {*name, "X" + *name}) {  // inline forms leave out the X
        if (!point && points_.count(each) > 0) {
          point = points_.at(each);
        }
      }
      if (scanner->peek() == ':' || scanner->peek() == '[') {
        fail(fmt::format("'{}': a point that is computed cannot be told",
                         files::one_line(*name, 30)));
      }
    }
    return point;
  }

  KrlPoint whole(KrlPoint point) const {
    point.fill_from(at_);
    if (!point.is_whole()) {
      fail("the point lacks some of X, Y, Z, A, B and C, and no point before it tells them");
    }
    return point;
  }

  void refuse_hidden() {
    if (const char* why = nesting_.why_no_motion()) {
      fail(why);
    }
  }

  /// A place that is not Cartesian, or not known: nothing is planned, and what is not said of the
  /// next point cannot be filled in.
  void leave_out(const std::string& why) {
    note(why);
    at_ = {};
    is_lost_ = true;
  }

  void read_rapid(Scanner* scanner) {
    refuse_hidden();
    std::string name;
    const std::optional<KrlPoint> point = read_target(scanner, &name);
    if (!point) {
      leave_out(fmt::format("'{}': no file tells this point; the motion is left as it is",
                            files::one_line(name, 30)));
    } else if (point->has_axes) {
      leave_out("a point in joint angles; the motion is left as it is");
    } else {
      add(MotionKind::rapid, whole(*point), {});
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
    refuse_hidden();
    KrlPoint point = read_known_target(scanner);
    if (word == "LIN_REL" || word == "SLIN_REL") {
      point = moved_by(point, scanner);
    }
    read_own_feed(scanner);
    add(is_lost_ ? MotionKind::rapid : MotionKind::linear, whole(point), {});
    own_feed_.reset();
  }

  KrlPoint moved_by(KrlPoint point, Scanner* scanner) const {
    if (point.frame[3] || point.frame[4] || point.frame[5] ||
        scanner->rest().find("#TOOL") != std::string_view::npos) {
      fail("a relative motion that turns, or in the tool's frame, is not read");
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (point.frame[i] && at_.frame[i]) {
        *point.frame[i] += *at_.frame[i];
      }
    }
    return point;
  }

  /// SLIN … WITH $VEL.CP=0.1: of this motion alone.
  void read_own_feed(Scanner* scanner) {
    const std::size_t at = scanner->rest().find("$VEL.CP");
    if (at == std::string_view::npos) {
      return;
    }
    scanner->go_to(scanner->place() + at + 7);
    if (scanner->take('=')) {
      own_feed_ = known_feed(scanner->number());
    }
  }

  void read_circular(Scanner* scanner) {
    refuse_hidden();
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
    read_own_feed(scanner);
    const Vector3<double> from = program_.motions.back().end.position;
    KrlPoint on_the_way = between;
    on_the_way.fill_from(end);
    const std::optional<Arc> arc =
        arc_through(from, on_the_way.pose().position, end.pose().position);
    if (!arc) {
      fail("start, point between and end of the circle lie on a line");
    }
    add(MotionKind::circular, end, *arc, angle);
    own_feed_.reset();
  }

  void add(MotionKind kind, const KrlPoint& point, const Arc& arc, double angle = 0) {
    Motion motion;
    motion.kind = kind;
    motion.end = point.pose();
    motion.arc = arc;
    if (angle != 0) {
      go_round(angle, &motion);
    }
    motion.feed = kind == MotionKind::rapid ? 0 : own_feed_.value_or(feed_);
    motion.is_cutting = kind != MotionKind::rapid;
    motion.line = line_;
    motion.begin = begin_;
    motion.finish = finish_;
    append(motion, &program_);
    at_ = point;
    if (angle != 0) {
      for (std::size_t i = 0; i < 3; ++i) {
        at_.frame[i] = 1e3 * motion.end.position[static_cast<Eigen::Index>(i)];
      }
    }
    is_lost_ = false;
  }

  /// CA: so far round from the start, whatever the end says; backwards where it is below zero.
  void go_round(double angle, Motion* motion) const {
    if (angle < 0) {
      motion->arc.normal = -motion->arc.normal;
    }
    motion->arc.angle = std::abs(angle);
    Motion further = *motion;
    further.arc.angle = 2 * motion->arc.angle;
    motion->end.position = pose_at(program_.motions.back().end, further, 0.5).position;
  }

  Program& program_;
  std::map<std::string, KrlPoint> points_;
  KrlPoint at_;
  double feed_ = 0;
  std::optional<double> own_feed_;
  bool is_lost_ = true;
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
