#include "programs/rapid_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/nesting.hpp"
#include "programs/rapid_statements.hpp"
#include "programs/rapid_values.hpp"

namespace flexcomp::programs {
namespace {

const std::set<std::string> kRapidOpening = {"FOR", "WHILE", "TEST"};
const std::set<std::string> kRapidClosing = {"ENDIF", "ENDFOR", "ENDWHILE", "ENDTEST"};
const std::set<std::string> kRapidRoutines = {"PROC", "FUNC", "TRAP"};
const std::set<std::string> kRapidWithoutMotion = {
    "MODULE",  "ENDMODULE", "ENDPROC", "ENDFUNC",  "ENDTRAP",   "ELSE",      "ELSEIF",   "CASE",
    "DEFAULT", "ERROR",     "UNDO",    "RECORD",   "ENDRECORD", "BACKWARD",  "RETURN",   "STOP",
    "EXIT",    "CONFL",     "CONFJ",   "SINGAREA", "ACCSET",    "VELSET",    "RESET",    "SET",
    "INCR",    "DECR",      "ADD",     "CLEAR",    "ACTUNIT",   "DEACTUNIT", "GRIPLOAD", "CONNECT",
    "RAISE",   "RETRY",     "TRYNEXT", "PULSEDO",  "LABEL",     "GOTO",      "OPEN",     "CLOSE",
    "WRITE",   "CLKSTART",  "CLKSTOP", "CLKRESET", "STOPMOVE",  "STARTMOVE"};
constexpr std::array<std::string_view, 5> kWithoutMotionBegin = {"SETDO", "SETAO", "SETGO", "WAIT",
                                                                 "TP"};
constexpr std::array<std::string_view, 5> kMovingBegin = {"MOVE", "TRIGG", "SEARCH", "ARC", "PATH"};

template <std::size_t Count>
bool begins_with_one_of(const std::array<std::string_view, Count>& beginnings,
                        const std::string& word) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view each) {
    return word.compare(0, each.size(), each) == 0;
  });
}

bool is_unreadable_motion(const std::string& word) {
  return word != "PATHACCLIM" && word != "PATHRESOL" && begins_with_one_of(kMovingBegin, word);
}

class RapidReader {
 public:
  explicit RapidReader(Program* program) : program_(*program) {}

  void read() {
    declare_all();
    RapidStatements statements(program_.text);
    while (statements.next(&statement_)) {
      Scanner scanner(statement_.text);
      read_statement(&scanner);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    refuse(program_.file, statement_.line, why);
  }
  void note(const std::string& text) { program_.notes.push_back({statement_.line, text}); }

  /// Data of a module may stand below the routine that uses it.
  void declare_all() {
    RapidStatements statements(program_.text);
    while (statements.next(&statement_)) {
      Scanner scanner(statement_.text);
      data_.read_declaration(scanner.name(), &scanner);
    }
  }

  void read_statement(Scanner* scanner) {
    std::string word = scanner->name();
    const std::size_t after = scanner->place();
    if (word == "LOCAL" && kRapidRoutines.count(scanner->name()) > 0) {
      word = "PROC";
    } else {
      scanner->go_to(after);
    }
    if (kRapidRoutines.count(word) > 0) {
      nesting_.begin_routine();
    } else if (word == "IF") {
      read_condition(scanner);
    } else if (kRapidOpening.count(word) > 0) {
      nesting_.open();
    } else if (kRapidClosing.count(word) > 0) {
      nesting_.close();
    } else if (word == "MOVEJ" || word == "MOVEL" || word == "MOVEC") {
      read_motion(word, scanner);
    } else if (word == "MOVEABSJ") {
      leave_out("a point in joint angles; the motion is left as it is");
    } else if (is_unreadable_motion(word)) {
      fail(fmt::format("'{}': this motion is not read", files::one_line(word, 30)));
    } else if (!data_.read_declaration(word, scanner)) {
      read_other(word, scanner);
    }
  }

  /// IF … THEN opens a block; without it the rest is one statement.
  void read_condition(Scanner* scanner) {
    while (!scanner->at_end()) {
      const std::string word = scanner->name();
      if (word == "THEN") {
        nesting_.open();
        return;
      }
      if (is_unreadable_motion(word)) {
        fail(kInBranch);
      }
      if (word.empty()) {
        scanner->go_to(scanner->place() + 1);
      }
    }
  }

  void read_other(const std::string& word, Scanner* scanner) {
    if (scanner->take(':') && scanner->take('=')) {
      const std::optional<Pose<double>> pose = data_.target(scanner);
      data_.targets.erase(word.substr(0, word.find('.')));
      if (pose && scanner->at_end()) {
        data_.targets[word] = *pose;
      }
    } else if (kRapidWithoutMotion.count(word) == 0 &&
               !begins_with_one_of(kWithoutMotionBegin, word)) {
      note(fmt::format("'{}' is unknown; if it moves the robot, its way is missing",
                       files::one_line(word.empty() ? statement_.text : word, 30)));
    }
  }

  void leave_out(const std::string& why) {
    note(why);
    is_lost_ = true;
  }

  void refuse_hidden() {
    if (const char* why = nesting_.why_no_motion()) {
      fail(why);
    }
  }

  void read_motion(const std::string& word, Scanner* scanner) {
    refuse_hidden();
    pass_options(scanner);
    scanner->take(',');
    std::optional<Pose<double>> between;
    if (word == "MOVEC") {
      between = data_.target(scanner);
      pass_options(scanner);
      if (!between || !scanner->take(',')) {
        fail("the point between is not one that this module tells");
      }
    }
    const std::optional<Pose<double>> end = data_.target(scanner);
    if (!end && word == "MOVEJ") {
      leave_out("the module does not tell this point; the motion is left as it is");
      return;
    }
    if (!end) {
      fail("the point is not one that this module tells");
    }
    pass_options(scanner);
    const double feed = read_feed(scanner);
    read_work_object(scanner->rest());
    add(word, between, *end, feed);
  }

  /// \Conc, \ID:=10 and the like.
  static void pass_options(Scanner* scanner) {
    while (scanner->take('\\')) {
      scanner->name();
      if (scanner->take(':') && scanner->take('=') && !scanner->number()) {
        scanner->name();
      }
    }
  }

  double read_feed(Scanner* scanner) {
    if (!scanner->take(',')) {
      fail("expected a comma and the speed");
    }
    std::optional<double> feed = data_.speed(scanner);
    while (scanner->take('\\')) {
      const std::string option = scanner->name();
      const std::optional<double> value =
          scanner->take(':') && scanner->take('=') ? scanner->number() : std::nullopt;
      if (option == "V" && value && *value > 0) {
        feed = kMillimetre * *value;
      }
    }
    if (!feed) {
      note("the module does not tell the speed; the default is used");
    }
    return feed.value_or(0);
  }

  void read_work_object(std::string_view rest) {
    std::string name = "WOBJ0";
    for (std::size_t at = rest.find('\\'); at != std::string_view::npos;
         at = rest.find('\\', at + 1)) {
      Scanner option(rest.substr(at + 1));
      if (option.name() == "WOBJ" && option.take(':') && option.take('=')) {
        name = option.name();
      }
    }
    if (!work_object_.empty() && name != work_object_) {
      fail(fmt::format("'{}': a second work object; one work frame is planned at a time",
                       files::one_line(name, 30)));
    }
    if (work_object_.empty()) {
      work_object_ = name;
      set_frame(name);
    }
  }

  void set_frame(const std::string& name) {
    const auto found = data_.frames.find(name);
    if (name == "WOBJ0") {
      program_.frame = Pose<double>{};
    } else if (found != data_.frames.end()) {
      program_.frame = found->second;
    } else {
      note(
          fmt::format("'{}': the module does not tell this work object; without --frame the work "
                      "is put where the robot reaches it",
                      files::one_line(name, 30)));
    }
  }

  void add(const std::string& word, const std::optional<Pose<double>>& between,
           const Pose<double>& end, double feed) {
    Motion motion;
    const bool is_rapid = word == "MOVEJ" || (is_lost_ && word == "MOVEL");
    motion.kind = is_rapid          ? MotionKind::rapid
                  : word == "MOVEL" ? MotionKind::linear
                                    : MotionKind::circular;
    motion.end = end;
    if (between) {
      if (is_lost_) {
        fail("a circle from a point that the module does not tell");
      }
      const std::optional<Arc> arc =
          arc_through(program_.motions.back().end.position, between->position, end.position);
      if (!arc) {
        fail("start, point between and end of the circle lie on a line");
      }
      motion.arc = *arc;
    }
    motion.feed = is_rapid ? 0 : feed;
    motion.is_cutting = !is_rapid;
    motion.line = statement_.line;
    motion.begin = statement_.begin;
    motion.finish = statement_.finish;
    append(motion, &program_);
    is_lost_ = false;
  }

  Program& program_;
  RapidData data_;
  RapidStatement statement_;
  std::string work_object_;
  bool is_lost_ = true;
  Nesting nesting_;
};

}  // namespace

Program rapid_program(const std::string& file, std::string text) {
  Program program = unread(Format::rapid, file, std::move(text));
  RapidReader(&program).read();
  return program;
}

Program read_rapid(const std::filesystem::path& file) {
  return rapid_program(file.string(), files::read_text(file));
}

}  // namespace flexcomp::programs
