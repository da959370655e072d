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

bool KrlSettings::is_setting(const std::string& word, Scanner scanner) {
  if (word == "BAS") {
    scanner.take('(');
    scanner.take('#');
    return kSettingsOfBas.count(scanner.name()) > 0;
  }
  return kSettings.count(whole_name(word)) > 0 && scanner.peek() == '=';
}

bool KrlSettings::assign(const std::string& name, std::size_t line, Scanner* scanner) {
  if (kSettings.count(whole_name(name)) == 0) {
    return false;
  }
  if (name == "$VEL.CP") {
    read_feed(line, scanner, &state_);
    if (!scanner->at_end()) {
      fail(line,
           fmt::format("expected a number alone, found '{}' behind it", shown(scanner->rest())));
    }
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
  } else if (whole_name(name) != "$VEL") {  // the speeds of turning are no way
    fail(line, fmt::format("'{}': a component alone is not read; give the whole", shown(name)));
  }
  return true;
}

void KrlSettings::set_feed(const std::optional<double>& feed, std::size_t line, KrlState* state) {
  if (feed && *feed > 0) {
    state->feed = *feed;
  } else {
    note(line, "the feed is not a number above zero here; that before it is used");
  }
}

/// What is no number at all, as a name, is passed over; the feed is then not known.
void KrlSettings::read_feed(std::size_t line, Scanner* scanner, KrlState* state) {
  const std::optional<double> feed = scanner->number();
  set_feed(feed, line, state);
  if (!feed) {
    scanner->go_to(scanner->place() + scanner->rest().size());
  }
}

void KrlSettings::read_speeds(std::size_t line, Scanner* scanner) {
  const auto aggregate = read_krl_aggregate(scanner);
  const KrlComponent* const feed = aggregate ? component_of(*aggregate, "CP") : nullptr;
  if (!aggregate || feed != nullptr) {
    set_feed(feed != nullptr ? feed->number : std::nullopt, line, &state_);
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
  const bool is_enumeration = scanner->take('#');
  const std::string value = scanner->name();
  const bool is_planned = name == "$ORI_TYPE" ? value == "VAR" : value == "BASE";
  if (name != "$CIRC_MODE" && !(is_enumeration && is_planned)) {
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
    const std::optional<double> feed = has_value ? scanner->number() : std::nullopt;
    set_feed(feed, line, &state_);
    if (feed && !scanner->take(')')) {
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
  if (name == "$VEL.CP" || (name == "$VEL" && function == "SVEL_CP" && inside)) {
    set_feed(value->number(), line, state);
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
