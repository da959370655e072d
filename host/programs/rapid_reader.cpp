#include "programs/rapid_reader.hpp"

#include <fmt/format.h>

#include <set>

#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "programs/nesting.hpp"
#include "programs/rapid_motions.hpp"
#include "programs/rapid_routines.hpp"
#include "programs/rapid_statements.hpp"
#include "programs/rapid_words.hpp"

namespace flexcomp::programs {
namespace {

constexpr int kMostCalls = 2000;  // in all
constexpr std::size_t kDeepestCall = 50;
constexpr int kMostInLine = 20;  // statements

class RapidReader {
 public:
  explicit RapidReader(Program* program) : program_(*program) {}

  void read() {
    data_.read_all(program_.text);
    routines_ = rapid_routines(program_.text);
    moving_ = moving_routines(routines_);
    joint_moving_ = joint_moving_routines(routines_);
    const std::size_t outside = routines_.at("").motion_line;
    if (outside != 0 && routines_.size() > 1) {
      refuse(program_.file, outside, "a motion outside of all routines is not read");
    }
    nesting_.begin_routine();
    run(first_routine(routines_, moving_));
    for (const auto& [name, routine] : routines_) {
      if (routine.motion_line != 0 && ran_.count(name) == 0) {
        refuse(program_.file, routine.motion_line,
               "a motion in a second routine: when it is called cannot be told");
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    refuse(program_.file, statement_.line, why);
  }
  void note(const std::string& text) { program_.notes.push_back({statement_.line, text}); }

  void run(const std::string& name) {
    const RapidRoutine& routine = routines_.at(name);
    ran_.insert(name);
    const std::size_t line_over = line_over_;
    const int depth = routine_depth_;
    routine_depth_ = nesting_.depth();
    RapidStatements statements(program_.text, routine.begin, routine.line);
    while (statements.next(&statement_)) {
      Scanner scanner(statement_.text);
      const std::string word = scanner.name();
      if (!name.empty() && ends_rapid_routine(word)) {
        break;
      }
      if (!name.empty() && statement_.begin != routine.begin &&
          !rapid_routine_begun(Scanner(statement_.text)).empty()) {
        fail("a routine in another one: is its end, ENDPROC, missing?");
      }
      if (line_over_ != 0) {
        pass_what_is_not_run(word);
      } else {
        read_statement(word, &scanner);
      }
    }
    routine_depth_ = depth;
    line_over_ = has_ended_ ? line_over_ : line_over;
  }

  void pass_what_is_not_run(const std::string& word) {
    if ((is_rapid_motion(word) || moving_.count(word) > 0) && !has_told_of_end_) {
      note(fmt::format("what stands behind line {} is not run; it is left as it is", line_over_));
      has_told_of_end_ = true;
    }
  }

  void read_statement(const std::string& word, Scanner* scanner) {
    if (begins_rapid_routine(word) || word == "LOCAL" || word == "TASK") {
      read_header(word, scanner);
    } else if (word == "IF" || word == "ELSEIF") {
      read_condition(word == "IF", scanner);
    } else if (opens_rapid_block(word)) {
      nesting_.open();
      read_behind("DO", scanner);
    } else if (closes_rapid_block(word)) {
      nesting_.close();
      read_rest(scanner);
    } else if (word == "ELSE" || word == "CASE" || word == "DEFAULT") {
      read_case(word, scanner);
    } else if (word == "MOVEJ" || word == "MOVEL" || word == "MOVEC") {
      motions_.read(word, scanner);
    } else if (word == "MOVEABSJ") {
      motions_.pass_joints(scanner);
    } else if (!word.empty() && routines_.count(word) > 0) {
      call(word, scanner);
    } else if (is_unreadable_rapid_motion(word)) {
      fail(fmt::format("'{}': this motion is not read", files::one_line(word, 30)));
    } else if (!leave(word) && !motions_.set(word, scanner) &&
               !data_.read_declaration(word, scanner)) {
      read_other(word, scanner);
    }
  }

  /// LOCAL PROC name(num x): what stands behind it in its line would be missed.
  void read_header(const std::string& word, Scanner* scanner) {
    if (data_.read_declaration(word, scanner)) {
      return;
    }
    const std::size_t close = scanner->rest().find(')');
    if (close != std::string_view::npos) {
      scanner->go_to(scanner->place() + close + 1);
      read_rest(scanner);
    }
  }

  /// A statement in the line of another one: the writer could not tell them apart.
  void read_rest(Scanner* scanner) {
    if (!scanner->at_end()) {
      if (++in_line_ > kMostInLine) {
        fail("too many statements in one line");
      }
      motions_.stand_within(true);
      const std::string word = scanner->name();
      if (!word.empty()) {
        read_statement(word, scanner);
      }
      motions_.stand_within(false);
      --in_line_;
    }
  }

  void read_behind(const char* last, Scanner* scanner) {
    while (!scanner->at_end()) {
      const std::string word = scanner->name();
      if (word == last) {
        read_rest(scanner);
        return;
      }
      scanner->go_to(scanner->place() + (word.empty() ? 1 : 0));
    }
  }

  void read_case(const std::string& word, Scanner* scanner) {
    const std::size_t colon = word == "ELSE" ? 0 : scanner->rest().find(':');
    if (colon != std::string_view::npos) {
      scanner->go_to(scanner->place() + colon + (word == "ELSE" ? 0 : 1));
      read_rest(scanner);
    }
  }

  /// IF … THEN opens a block; without it the rest is one statement.
  void read_condition(bool opens, Scanner* scanner) {
    std::string last;
    while (!scanner->at_end()) {
      const std::string word = scanner->name();
      if (word == "THEN") {
        if (opens) {
          nesting_.open();
        }
        read_rest(scanner);
        return;
      }
      if (is_rapid_motion(word) || moving_.count(word) > 0 || joint_moving_.count(word) > 0) {
        fail(kInBranch);
      }
      read_in_condition(word, last, scanner);
      last = word.empty() ? last : word;
    }
  }

  /// A word of a condition, or of the statement behind it that may be run.
  void read_in_condition(const std::string& word, const std::string& last, Scanner* scanner) {
    nesting_.open();
    if (word.empty() && scanner->take(':')) {
      if (scanner->take('=')) {
        data_.forget_target(last);
      }
    } else if (word.empty()) {
      scanner->go_to(scanner->place() + 1);
    } else if (routines_.count(word) > 0) {
      if (active_.count(word) == 0) {  // else it is followed already
        call(word, scanner);
      }
    } else if (!leave(word)) {
      motions_.set(word, scanner);
    }
    nesting_.close();
  }

  /// What leaves the routine, or goes elsewhere in it.
  bool leave(const std::string& word) {
    const bool is_exit = word == "EXIT" || word == "EXITCYCLE";
    if (word != "RETURN" && word != "GOTO" && !is_exit) {
      return false;
    }
    const std::string why =
        fmt::format("'{}': whether the motions here are run cannot be told", word);
    if (word == "GOTO" && nesting_.moves_here()) {
      fail(why);
    }
    if (word != "GOTO" && nesting_.depth() == (is_exit ? 0 : routine_depth_)) {
      line_over_ = statement_.line;
      has_ended_ = is_exit;
    } else if (is_exit) {
      motions_.doubt(why);
    } else {
      nesting_.doubt(statement_.line, why);
    }
    return true;
  }

  /// A call of a routine of the module is followed. Its motions stand in the text once, so they can
  /// be corrected for one call only.
  void call(const std::string& word, Scanner* scanner) {
    const std::string name = files::one_line(word, 30);
    if (active_.count(word) > 0 || active_.size() >= kDeepestCall || ++calls_ > kMostCalls) {
      fail(fmt::format("'{}' calls itself, or is called too often to be followed", name));
    }
    if (moving_.count(word) > 0 && ran_.count(word) > 0) {
      fail(
          fmt::format("'{}' is called a second time: its motions can be corrected for one call "
                      "only",
                      name));
    }
    if (moving_.count(word) > 0 && !scanner->at_end()) {
      fail(fmt::format("'{}' moves with arguments, which are not followed", name));
    }
    const RapidStatement here = statement_;
    const int depth = nesting_.depth();
    const std::optional<Doubt> doubt_here = nesting_.doubt();
    motions_.stand_within(false);
    active_.insert(word);
    run(word);
    active_.erase(word);
    nesting_.come_back(depth, doubt_here);
    statement_ = here;
  }

  void read_other(const std::string& word, Scanner* scanner) {
    const bool is_element = scanner->peek() == '{';
    const std::size_t close = is_element ? scanner->rest().find('}') : std::string_view::npos;
    scanner->go_to(scanner->place() + (close == std::string_view::npos ? 0 : close + 1));
    if (scanner->take(':')) {
      if (scanner->take('=')) {
        assign(word, is_element, scanner);
      } else {
        read_behind_label(scanner);
      }
    } else if (!is_rapid_without_motion(word)) {
      note(fmt::format("'{}' is unknown; if it moves the robot, its way is missing",
                       files::one_line(word.empty() ? statement_.text : word, 30)));
    }
  }

  void read_behind_label(Scanner* scanner) {
    const std::string word = Scanner(*scanner).name();
    if (is_rapid_motion(word) || moving_.count(word) > 0) {
      fail("a motion behind a label is not read: how often it is run cannot be told");
    }
    read_rest(scanner);
  }

  void assign(const std::string& word, bool is_element, Scanner* scanner) {
    const std::optional<RapidTarget> target = data_.target(scanner);
    data_.forget_target(word);
    const bool is_whole = !is_element && word.find('.') == std::string::npos;
    if (target && scanner->at_end() && is_whole && nesting_.is_surely_run()) {
      data_.targets[word] = *target;
    }
  }

  Program& program_;
  RapidData data_;
  RapidStatement statement_;
  Nesting nesting_;
  RapidMotions motions_{&program_, &data_, &statement_, &nesting_};
  RapidRoutines routines_;
  std::set<std::string> moving_;
  std::set<std::string> joint_moving_;
  std::set<std::string> ran_;
  std::set<std::string> active_;
  int calls_ = 0;
  int in_line_ = 0;            ///< statements that stand in the line of another one
  int routine_depth_ = 0;      ///< of branches, where the routine that is read is called
  std::size_t line_over_ = 0;  ///< behind which nothing is run; zero where all is
  bool has_ended_ = false;     ///< is that so for the callers too?
  bool has_told_of_end_ = false;
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
