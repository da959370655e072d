#include "programs/krl_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "files/one_line.hpp"

namespace flexcomp::programs {
namespace {

const std::set<std::string> kSettings = {"$VEL.CP",   "$VEL",       "$BASE",     "$TOOL",
                                         "$IPO_MODE", "$ORI_TYPE",  "$OV_PRO",   "FDAT_ACT",
                                         "LDAT_ACT",  "$CIRC_TYPE", "$CIRC_MODE"};
const std::set<std::string> kSettingsOfBas = {"TOOL",   "BASE",       "EX_BASE",   "VEL_CP",
                                              "FRAMES", "PTP_PARAMS", "CP_PARAMS", "CP_DAT"};
/// What a spline motion may say of itself that changes neither its way nor its feed.
constexpr std::array<std::string_view, 6> kWithoutWay = {"$ACC",       "$APO",  "$JERK",
                                                         "$GEAR_JERK", "$LOAD", "$COLLMON"};

std::string whole_name(const std::string& name) {
  return name == "$VEL.CP" ? name : name.substr(0, name.find('.'));
}

/// What stands between the brackets that begin here, which are passed.
std::optional<std::string_view> inside_brackets(Scanner* scanner) {
  int depth = 0;
  scanner->peek();
  const std::string_view rest = scanner->rest();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    depth += rest[i] == '(' ? 1 : 0;
    depth -= rest[i] == ')' ? 1 : 0;
    if (depth == 0) {
      scanner->go_to(scanner->place() + i + 1);
      return rest.substr(1, i - (i > 0 ? 1 : 0));
    }
  }
  return std::nullopt;
}

std::string shown(std::string_view text) { return files::one_line(text, 30); }

std::string named(const KrlFrame& frame) {
  return frame.name.empty() ? "that before the program's" : shown(frame.name);
}

}  // namespace

double KrlState::turn_feed() const {
  const auto [slower, faster] = std::minmax(turning[0], turning[1]);
  return slower > 0 ? slower : faster;
}

bool KrlSettings::is_setting(const std::string& word, Scanner scanner) {
  if (word == "BAS") {
    scanner.take('(');
    scanner.take('#');
    return kSettingsOfBas.count(scanner.name()) > 0;
  }
  return kSettings.count(whole_name(word)) > 0 && scanner.peek() == '=';
}

void KrlSettings::assign(const std::string& name, std::size_t line, Scanner* scanner) {
  if (name == "$VEL.CP") {
    set_feed(read_speed(line, scanner).number, line, &state_);
    refuse_behind_speed(line, scanner);
  } else if (name == "$VEL.ORI1" || name == "$VEL.ORI2") {
    set_turning(name == "$VEL.ORI1" ? 0 : 1, read_speed(line, scanner), line);
    refuse_behind_speed(line, scanner);
  } else if (name == "$VEL") {
    read_speeds(line, scanner);
  } else if (name == "$BASE") {
    set_base(read_frame(name, line, scanner), line);
  } else if (name == "$TOOL") {
    note(line, "'$TOOL': the robot's own tool is used; the two must be the same");
    has_told_of_tool_ = true;
    set_tool(read_frame(name, line, scanner), line);
  } else if (name == "$OV_PRO") {
    set_override(line, scanner);
  } else if (name == "FDAT_ACT") {
    frame_data_ = data_.read_frame_data(scanner);
  } else if (name == "LDAT_ACT") {
    why_no_path_ = data_.why_no_path(scanner);
  } else if (name.find('.') == std::string::npos) {
    set_mode(name, line, scanner);
  } else {
    fail(line, fmt::format("'{}': a component alone is not read; give the whole", shown(name)));
  }
}

void KrlSettings::set_feed(const std::optional<double>& feed, std::size_t line, KrlState* state) {
  if (feed && *feed > 0) {
    state->feed = *feed;
  } else {
    note(line, "the feed is not a number above zero here; that before it is used");
  }
}

/// $VEL_MA has the most that the machine can, as is planned where nothing is said.
void KrlSettings::set_turning(std::size_t which, const KrlReadNumber& speed, std::size_t line) {
  if (speed.name.compare(0, 8, "$VEL_MA.") == 0) {
    state_.turning[which] = 0;
  } else if (speed.number && *speed.number > 0) {
    state_.turning[which] = *speed.number * kDegree;
  } else {
    note(line, "the speed of turning is not a number above zero here; that before it is used");
  }
}

KrlReadNumber KrlSettings::read_speed(std::size_t line, Scanner* scanner) const {
  KrlReadNumber speed = data_.read_number(scanner);
  if (!speed.why.empty()) {
    fail(line, speed.why);
  }
  return speed;
}

void KrlSettings::refuse_behind_speed(std::size_t line, Scanner* scanner) const {
  if (!scanner->at_end()) {
    fail(line,
         fmt::format("expected a number alone, found '{}' behind it", shown(scanner->rest())));
  }
}

void KrlSettings::read_speeds(std::size_t line, Scanner* scanner) {
  if (scanner->peek() != '{') {
    set_feed(std::nullopt, line, &state_);
    read_speed(line, scanner);
    refuse_behind_speed(line, scanner);
    return;
  }
  const auto aggregate = read_krl_aggregate(scanner);
  if (!aggregate) {
    fail(line, "expected speeds such as {CP 0.1,ORI1 200,ORI2 200}");
  }
  const auto speed_of = [&](const KrlComponent& component) {
    KrlReadNumber speed;
    speed.number = component.number;
    Scanner name(component.word);
    return component.number ? speed : read_speed(line, &name);
  };
  for (const KrlComponent& each : *aggregate) {
    if (each.name == "CP") {
      set_feed(speed_of(each).number, line, &state_);
    } else if (each.name == "ORI1" || each.name == "ORI2") {
      set_turning(each.name == "ORI1" ? 0 : 1, speed_of(each), line);
    }
  }
}

void KrlSettings::set_override(std::size_t line, Scanner* scanner) {
  const double percent = scanner->number().value_or(0);
  if (!(percent > 0 && percent <= 100) || !scanner->at_end()) {
    fail(line, "'$OV_PRO': expected a number above zero and not above 100");
  }
  state_.override = percent / 100;
}

KrlFrame KrlSettings::read_frame(const std::string& name, std::size_t line, Scanner* scanner) {
  KrlFrame frame;
  const std::string array = name.substr(1) + "_DATA";
  const std::size_t begin = scanner->place();
  const bool is_literal = scanner->peek() == '{';
  const KrlReadPoint read = data_.read_point(scanner);
  if (!is_literal && read.name.compare(0, array.size() + 1, array + "[") == 0 &&
      scanner->at_end() && read.why.empty()) {
    scanner->go_to(begin);
    frame = data_.read_frame_name(array, scanner);
    return frame;
  }
  if (!read.why.empty() && (is_literal || scanner->peek() == ':')) {
    fail(line, fmt::format("'{}': {}", name, read.why));
  }
  if (!scanner->at_end() && read.point) {
    fail(line, fmt::format("'{}': expected one frame, found '{}' behind it", name,
                           shown(scanner->rest())));
  }
  if (read.point && read.point->is_whole() && !read.point->has_axes) {
    frame.value = read.point->pose();
  }
  scanner->go_to(begin);
  frame.is_loaded = !frame.value || !(is_literal || read.name == "$NULLFRAME");
  frame.name = is_literal ? "its value" : shown(scanner->rest());
  return frame;
}

void KrlSettings::set_base(KrlFrame frame, std::size_t line) {
  frame.line = line;
  if (first_) {
    if (!frame.is_same(first_->base)) {
      fail(line, "a second $BASE; one work frame is planned at a time");
    }
    program_.loads_frame = true;
  }
  state_.base = std::move(frame);
}

void KrlSettings::set_tool(KrlFrame frame, std::size_t line) {
  frame.line = line;
  if (first_ && !frame.is_same(first_->tool)) {
    fail(line, "a second $TOOL; one tool is planned at a time");
  }
  state_.tool = std::move(frame);
}

/// How the way from one point to the next is made: as it is planned, or refused.
void KrlSettings::set_mode(const std::string& name, std::size_t line, Scanner* scanner) {
  if (name == "$CIRC_MODE") {
    fail(line, "'$CIRC_MODE' is not read: the tool may turn otherwise along a circle");
  }
  const bool is_enumeration = scanner->take('#');
  const std::string value = scanner->name();
  const bool is_planned = name == "$ORI_TYPE" ? value == "VAR" : value == "BASE";
  if (!(is_enumeration && is_planned)) {
    fail(line, fmt::format("'{}' other than #{} is not read: the way between two points is another",
                           name, name == "$ORI_TYPE" ? "VAR" : "BASE"));
  }
}

void KrlSettings::call_bas(std::size_t line, Scanner* scanner) {
  scanner->take('(');
  scanner->take('#');
  const std::string what = scanner->name();
  const bool has_value = scanner->take(',');
  if (what == "EX_BASE") {
    fail(line, "'#EX_BASE': a base that moves is not read");
  }
  if (what == "BASE" || what == "TOOL") {
    KrlFrame frame = data_.read_frame_name(what + "_DATA", scanner);
    what == "BASE" ? set_base(std::move(frame), line) : set_tool(std::move(frame), line);
  } else if (what == "VEL_CP" || what == "CP_PARAMS") {
    set_feed(has_value ? read_speed(line, scanner).number : std::nullopt, line, &state_);
    if (has_value && !scanner->take(')')) {
      fail(line,
           fmt::format("expected a number alone, found '{}' behind it", shown(scanner->rest())));
    }
  }
  if (what == "FRAMES" || what == "PTP_PARAMS" || what == "CP_PARAMS") {
    load(line);
  }
  if ((what == "CP_PARAMS" || what == "CP_DAT") && !why_no_path_.empty()) {
    fail(line, why_no_path_);
  }
}

/// BAS loads base and tool by the numbers of FDAT_ACT. Whether a motion is made with them is looked
/// at there: HOME has numbers of its own.
void KrlSettings::load(std::size_t line) {
  if (!frame_data_) {
    return;
  }
  state_.base = frame_data_->base;
  state_.tool = frame_data_->tool;
  state_.base.line = state_.tool.line = line;
  state_.is_on_tool = frame_data_->is_on_tool;
}

KrlState KrlSettings::with(std::size_t line, Scanner* scanner) {
  KrlState state = state_;
  do {
    const std::string name = scanner->name();
    if (scanner->take('[')) {
      scanner->number();
      scanner->take(']');
    }
    if (name.empty() || !scanner->take('=')) {
      fail(line, "expected a setting such as $VEL.CP=0.1 behind WITH");
    }
    set_of_motion(name, line, scanner, &state);
  } while (scanner->take(','));
  return state;
}

void KrlSettings::set_of_motion(const std::string& name, std::size_t line, Scanner* scanner,
                                KrlState* state) {
  const std::size_t begin = scanner->place();
  std::string function = scanner->name();
  std::optional<std::string_view> inside;
  if (!function.empty() && scanner->peek() == '(') {
    inside = inside_brackets(scanner);
  } else {
    scanner->go_to(begin);
  }
  Scanner arguments(inside.value_or(std::string_view{}));
  Scanner* const value = inside ? &arguments : scanner;
  if ((name == "$VEL.CP" && !inside) || (name == "$VEL" && function == "SVEL_CP" && inside)) {
    set_feed(read_speed(line, value).number, line, state);
    if (inside && !value->at_end() && value->peek() != ',') {
      fail(line, fmt::format("'{}': expected a number alone", name));
    }
  } else if (name == "$BASE") {
    state->base = data_.read_frame_name("BASE_DATA", value);
    state->base.line = line;
  } else if (name == "$TOOL") {
    state->tool = data_.read_frame_name("TOOL_DATA", value);
    state->tool.line = line;
  } else if (name == "$IPO_MODE" && inside) {
    std::string data = value->name();
    Scanner fdat(data = data.substr(0, data.find('.')));
    state->is_on_tool = data_.read_frame_data(&fdat).is_on_tool;
  } else if ((name == "$ORI_TYPE" || name == "$CIRC_TYPE") && inside) {
    const std::string why = data_.why_no_path(value);
    if (!why.empty()) {
      fail(line, why);
    }
  } else if (name == "$IPO_MODE" || name == "$ORI_TYPE" || name == "$CIRC_TYPE") {
    set_mode(name, line, scanner);
  } else if (name.compare(0, 9, "$VEL_AXIS") == 0 ||
             std::any_of(kWithoutWay.begin(), kWithoutWay.end(), [&](std::string_view each) {
               return name.compare(0, each.size(), each) == 0;
             })) {
    if (!inside && !scanner->number()) {
      scanner->name();
    }
  } else {
    fail(line, fmt::format("'{}': this setting of a motion is not read", shown(name)));
  }
}

void KrlSettings::meet(const KrlState& state, std::size_t line) {
  if (state.is_on_tool) {
    fail(line, "a motion with the tool standing still (IPO_FRAME or $IPO_MODE #TCP) is not read");
  }
  if (first_) {
    if (!state.base.is_same(first_->base)) {
      fail(line, fmt::format("a second base, {}; one work frame is planned at a time",
                             named(state.base)));
    }
    if (!state.tool.is_same(first_->tool)) {
      fail(line,
           fmt::format("a second tool, {}; one tool is planned at a time", named(state.tool)));
    }
    return;
  }
  first_ = state;
  program_.frame = state.base.value;
  program_.loads_frame = state.base.is_loaded;
  if (!state.base.name.empty() && !state.base.value) {
    note(state.base.line,
         fmt::format("'$BASE': {} is not in the file; without --frame the work is put where the "
                     "robot reaches it",
                     shown(state.base.name)));
  }
  if (!state.tool.name.empty() && !has_told_of_tool_) {
    note(state.tool.line,
         fmt::format("'{}': the robot's own tool is used; the two must be the same",
                     state.tool.name));
  }
}

}  // namespace flexcomp::programs
