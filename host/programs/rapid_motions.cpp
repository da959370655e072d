#include "programs/rapid_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/one_line.hpp"
#include "programs/rapid_words.hpp"

namespace flexcomp::programs {
namespace {

constexpr const char* kNotATarget =
    "the point is not one that this module tells: expected a robtarget in numbers, by its name, as "
    "an element of an array, or by Offs or RelTool with numbers and constants of the module";

constexpr const char* kTimeBehindVelSet =
    "'\\T' behind VelSet: how long the motion lasts cannot be told";

bool is_axis(double value) { return std::abs(value) < 8.9e9; }

}  // namespace

/// What changes how motions behind it are made.
bool RapidMotions::set(const std::string& word, Scanner* scanner) {
  if (word == "PDISPOFF") {
    end_mode("PDISP");
  } else if (word == "EOFFSOFF") {
    end_mode("EOFFS");
  } else if (displaces_rapid_motions(word)) {
    modes_[word.substr(0, 5)] = {
        statement_->line,
        fmt::format("'{}' moves the points of the motions behind it, which is not read", word)};
  } else if (word == "SINGAREA" || word == "CIRPATHMODE") {
    set_orientation_mode(word, scanner);
  } else if (word == "SPEEDREFRESH" || (word == "VELSET" && !nesting_->is_surely_run())) {
    doubt(fmt::format("'{}' here: the speed of the motions behind it cannot be told", word));
  } else if (word == "VELSET") {
    const std::optional<double> percent = data_->number(scanner);
    const std::optional<double> most = scanner->take(',') ? data_->number(scanner) : std::nullopt;
    if (!percent || !most || !(*percent > 0) || !(*most > 0) || !scanner->at_end()) {
      fail("'VELSET': expected a percentage and a speed above zero");
    }
    override_ = *percent / 100;
    most_ = kMillimetre * *most;
  } else {
    return false;
  }
  return true;
}

/// How the tool turns on its way: another way than one rotation is not planned.
void RapidMotions::set_orientation_mode(const std::string& word, Scanner* scanner) {
  const std::string option = next_option(scanner).value_or("");
  if (option == "OFF" || option == "PATHFRAME" || option.empty()) {
    end_mode(word);
  } else {
    modes_[word] = {statement_->line,
                    fmt::format("'{} \\{}' changes how the tool turns on its way, which is not "
                                "planned",
                                word, files::one_line(option, 30))};
  }
}

void RapidMotions::end_mode(const std::string& name) {
  if (nesting_->is_surely_run()) {
    modes_.erase(name);
  }
}

/// Whatever routine it stands in, the motions behind are not known.
void RapidMotions::doubt(const std::string& why) {
  if (!doubt_) {
    doubt_ = Doubt{statement_->line, why};
  }
}

void RapidMotions::pass_joints(Scanner* scanner) {
  if (nesting_->is_inside()) {
    fail(kInBranch);
  }
  if (const std::optional<Doubt>& doubt = nesting_->doubt()) {
    refuse(program_.file, doubt->line, doubt->why);
  }
  pass_options({"CONC", "ID"}, scanner);
  scanner->take(',');
  if (const std::optional<RapidAxes> axes = data_->joint_axes(scanner)) {
    for (std::size_t i = 0; i < left_at_.size(); ++i) {
      left_at_[i] = is_axis((*axes)[i]) ? (*axes)[i] : left_at_[i];
    }
    left_in_ = statement_->line;
  }
  leave_out("a point in joint angles; the motion is left as it is");
}

void RapidMotions::leave_out(const std::string& why) {
  note(why);
  is_lost_ = true;
  lost_in_ = statement_->line;
}

void RapidMotions::refuse_hidden(const std::string& word) {
  if (const char* why = nesting_->why_no_motion()) {
    fail(why);
  }
  for (const std::optional<Doubt>& each : {nesting_->doubt(), doubt_}) {
    if (each) {
      refuse(program_.file, each->line, each->why);
    }
  }
  for (const auto& [name, mode] : modes_) {
    const bool is_of_others =
        (name == "SINGAREA" && word == "MOVEJ") || (name == "CIRPATHMODE" && word != "MOVEC");
    if (!is_of_others) {
      refuse(program_.file, mode.line, mode.why);
    }
  }
  if (is_within_) {
    fail("a motion in the line of another statement is not read");
  }
}

void RapidMotions::read(const std::string& word, Scanner* scanner) {
  refuse_hidden(word);
  pass_options({"CONC"}, scanner);
  scanner->take(',');
  std::optional<RapidTarget> between;
  if (word == "MOVEC") {
    between = data_->target(scanner);
    if (!between || !scanner->take(',')) {
      fail(kNotATarget);
    }
  }
  const std::optional<RapidTarget> end = data_->target(scanner);
  if (!end && word == "MOVEJ") {
    leave_out("the module does not tell this point; the motion is left as it is");
    return;
  }
  if (!end) {
    fail(kNotATarget);
  }
  pass_options({}, scanner);
  const Speed speed = read_speed(scanner);
  read_zone(scanner);
  read_tool(scanner);
  meet(*end);
  add(word, between, end->pose, speed);
}

/// \Conc, \Inpos:=inpos50 and the like, which change no way.
void RapidMotions::pass_options(std::initializer_list<std::string_view> known,
                                Scanner* scanner) const {
  while (const std::optional<std::string> option = next_option(scanner)) {
    if (std::find(known.begin(), known.end(), *option) == known.end()) {
      refuse_option(*option);
    }
    if (!scanner->number()) {
      scanner->name();
    }
  }
}

/// The name of an option, and what gives it a value passed over.
std::optional<std::string> RapidMotions::next_option(Scanner* scanner) {
  bool is_option = false;
  while (scanner->take('\\')) {
    is_option = true;
  }
  if (!is_option) {
    return std::nullopt;
  }
  std::string option = scanner->name();
  if (scanner->take(':')) {
    scanner->take('=');
  }
  return option;
}

void RapidMotions::refuse_option(const std::string& option) const {
  fail(fmt::format("'\\{}': this option of a motion is not read", files::one_line(option, 30)));
}

RapidMotions::Speed RapidMotions::read_speed(Scanner* scanner) {
  if (!scanner->take(',')) {
    fail("expected a comma and the speed");
  }
  Speed speed;
  const std::optional<RapidSpeed> given = data_->speed(scanner);
  std::optional<double> feed = given ? std::optional<double>(given->feed) : std::nullopt;
  while (const std::optional<std::string> option = next_option(scanner)) {
    const std::optional<double> value =
        *option == "V" || *option == "T" ? data_->number(scanner) : std::nullopt;
    if (!value || !(*value > 0)) {
      refuse_option(*option);
    }
    if (*option == "T") {
      speed.time = value;
    } else {
      feed = kMillimetre * *value;
    }
  }
  if (!feed && !speed.time) {
    note("the module does not tell the speed; the default is used");
  }
  speed.feed = std::min(feed.value_or(0) * override_, most_);
  const double turn = given ? given->turn * override_ : 0;
  speed.turn = turn < kFastestRapidTurn ? turn : 0;
  if (speed.time && override_ != 1) {
    fail(kTimeBehindVelSet);
  }
  return speed;
}

void RapidMotions::read_zone(Scanner* scanner) {
  if (!scanner->take(',')) {
    fail("expected a comma and the zone");
  }
  if (scanner->peek() == '[') {
    read_rapid_numbers(scanner);
  } else {
    scanner->name();
  }
  pass_options({"Z", "INPOS"}, scanner);
}

void RapidMotions::read_tool(Scanner* scanner) {
  const std::string tool = scanner->take(',') ? scanner->name() : "";
  if (tool.empty()) {
    fail("expected a comma and the tool by its name");
  }
  std::string work_object = "WOBJ0";
  while (const std::optional<std::string> option = next_option(scanner)) {
    const std::string value = scanner->name();
    if (*option == "WOBJ" && !value.empty()) {
      work_object = value;
    } else if (*option != "TLOAD") {
      refuse_option(*option);
    }
  }
  if (!scanner->at_end()) {
    fail(fmt::format("'{}' behind the tool is not read", files::one_line(scanner->rest(), 30)));
  }
  set_tool(tool);
  set_work_object(work_object);
}

void RapidMotions::set_tool(const std::string& name) {
  if (!tool_.empty() && name != tool_) {
    fail(fmt::format("'{}': a second tool; one tool is planned at a time",
                     files::one_line(name, 30)));
  }
  const auto found = data_->tools.find(name);
  if (found != data_->tools.end() && !found->second) {
    fail(
        fmt::format("'{}': a tool that the robot does not hold (robhold), or that the program "
                    "changes, is not planned",
                    files::one_line(name, 30)));
  }
  tool_ = name;
}

void RapidMotions::set_work_object(const std::string& name) {
  if (!work_object_.empty() && name != work_object_) {
    fail(fmt::format("'{}': a second work object; one work frame is planned at a time",
                     files::one_line(name, 30)));
  }
  if (work_object_.empty()) {
    work_object_ = name;
    set_frame(name);
  }
}

/// An external axis turns or carries the work or the robot: one that moves is not planned.
void RapidMotions::meet(const RapidTarget& target) {
  for (std::size_t i = 0; i < external_.size(); ++i) {
    const bool is_told = is_axis(target.external[i]);
    if (!is_told && !left_at_[i]) {
      continue;
    }
    const double to = is_told ? target.external[i] : *left_at_[i];
    if (to != external_[i].value_or(program_.motions.empty() ? to : 0)) {
      refuse(program_.file, is_told ? statement_->line : left_in_,
             "an external axis that moves is not planned");
    }
    external_[i] = to;
  }
  left_at_ = {};
  if (target.has_configuration && !has_told_of_posture_) {
    note("the posture that the configuration gives is not used: plan chooses one by itself");
    has_told_of_posture_ = true;
  }
}

void RapidMotions::set_frame(const std::string& name) {
  const auto found = data_->work_objects.find(name);
  if (name == "WOBJ0") {
    program_.frame = Pose<double>{};
  } else if (found != data_->work_objects.end()) {
    if (!found->second.why.empty()) {
      fail(fmt::format("'{}': {}; its way is not planned", files::one_line(name, 30),
                       found->second.why));
    }
    program_.frame = found->second.frame;
  } else {
    note(
        fmt::format("'{}': the module does not tell this work object; without --frame the work "
                    "is put where the robot reaches it",
                    files::one_line(name, 30)));
  }
}

void RapidMotions::add(const std::string& word, const std::optional<RapidTarget>& between,
                       const Pose<double>& end, const Speed& speed) {
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
        arc_through(program_.motions.back().end.position, between->pose.position, end.position);
    if (!arc) {
      fail("start, point between and end of the circle lie on a line");
    }
    motion.arc = *arc;
  }
  if (!is_rapid) {
    set_feed(speed, &motion);
  }
  motion.is_cutting = !is_rapid;
  motion.line = statement_->line;
  motion.begin = statement_->begin;
  motion.finish = statement_->finish;
  motion.has_known_start = !is_lost_ || program_.motions.empty();
  if (!motion.has_known_start) {
    note(
        fmt::format("where this motion begins is not known: line {} is left as it is; the way "
                    "here from line {} is planned as straight",
                    lost_in_, program_.motions.back().line));
  }
  append(motion, &program_);
  is_lost_ = false;
}

/// In a time (\T) it goes its way and turns.
void RapidMotions::set_feed(const Speed& speed, Motion* motion) const {
  if (!speed.time) {
    motion->feed = speed.feed;
    motion->turn_feed = speed.turn;
    return;
  }
  const Pose<double>& start = program_.motions.back().end;
  motion->feed = length_of(start, *motion) / *speed.time;
  motion->turn_feed = turn_between(start.rotation, motion->end.rotation) / *speed.time;
  if (motion->feed > most_) {
    fail(kTimeBehindVelSet);
  }
  if (!(motion->feed > 0 || motion->turn_feed > 0)) {
    fail("'\\T' of a motion that goes nowhere is not read");
  }
}

}  // namespace flexcomp::programs
