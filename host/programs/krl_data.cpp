#include "programs/krl_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "files/one_line.hpp"

namespace flexcomp::programs {
namespace {

const std::set<std::string> kKrlTypes = {"E6POS", "POS",  "FRAME", "E6AXIS", "AXIS",
                                         "FDAT",  "LDAT", "PDAT",  "REAL",   "INT"};
constexpr const char* kExpectedPoint = "expected a point such as {X 1, Y 2, Z 3, A 0, B 0, C 0}";

bool is_array_of_frames(const std::string& name) {
  return name == "BASE_DATA" || name == "TOOL_DATA";
}

bool moves_external_axis(const KrlPoint& point) {
  return std::any_of(point.external.begin(), point.external.end(),
                     [](const std::optional<double>& each) { return each && *each != 0; });
}

}  // namespace

bool KrlFrame::is_same(const KrlFrame& other) const {
  if (value && other.value) {
    return value->position == other.value->position && value->rotation == other.value->rotation;
  }
  return !value && !other.value && name == other.name;
}

std::string krl_indexed_name(std::string name, Scanner* scanner) {
  if (is_array_of_frames(name) && scanner->take('[')) {
    const std::optional<double> index = scanner->number();
    if (index && scanner->take(']')) {
      return fmt::format("{}[{:g}]", name, *index);
    }
  }
  return name;
}

bool KrlData::read_declaration(std::string word, Scanner* scanner) {
  const bool is_declared = word == "DECL" || word == "GLOBAL";
  while (word == "DECL" || word == "GLOBAL" || word == "CONST") {
    word = scanner->name();
  }
  const bool is_array = is_array_of_frames(word) && scanner->peek() == '[';
  if (is_array) {
    const std::string name = krl_indexed_name(word, scanner);
    if (scanner->take('=')) {
      assign(name, scanner);
    } else {
      forget(name);
    }
    return true;
  }
  if (kKrlTypes.count(word) == 0) {
    return is_declared;
  }
  do {
    const std::string name = krl_indexed_name(scanner->name(), scanner);
    if (scanner->take('=')) {
      assign(name, scanner);
    }
  } while (scanner->take(','));
  return true;
}

void KrlData::assign(const std::string& name, Scanner* scanner) {
  forget(name);
  if (scanner->peek() != '{') {
    const std::optional<double> number = scanner->number();
    const bool is_alone = scanner->at_end() || scanner->peek() == ',';
    numbers_[name] = is_alone ? number : std::nullopt;
    return;
  }
  numbers_[name].reset();
  const std::optional<std::vector<KrlComponent>> aggregate = read_krl_aggregate(scanner);
  if (!aggregate || !(scanner->at_end() || scanner->peek() == ',')) {
    return;
  }
  std::string why;
  if (const std::optional<KrlPoint> point = krl_point_of(*aggregate, &why)) {
    points_[name] = *point;
  } else {
    others_[name] = *aggregate;
  }
}

void KrlData::forget(const std::string& name) {
  const std::string whole = name.substr(0, name.find('.'));
  points_.erase(whole);
  others_.erase(whole);
  const auto number = numbers_.find(whole);
  if (number != numbers_.end()) {
    number->second.reset();
  }
  if (is_array_of_frames(whole)) {  // of an index that is computed
    for (auto each = points_.lower_bound(whole + "[");
         each != points_.end() && each->first.compare(0, whole.size(), whole) == 0;) {
      each = points_.erase(each);
    }
  }
}

std::optional<KrlPoint> KrlData::find_point(const std::string& name) const {
  for (const std::string& each : {name, "X" + name}) {
    const auto found = points_.find(each);
    if (found != points_.end()) {
      return found->second;
    }
  }
  return std::nullopt;
}

KrlReadPoint KrlData::read_operand(Scanner* scanner) const {
  KrlReadPoint read;
  if (scanner->peek() == '{') {
    const std::optional<std::vector<KrlComponent>> aggregate = read_krl_aggregate(scanner);
    read.point = aggregate ? krl_point_of(*aggregate, &read.why) : std::nullopt;
    if (!read.point && read.why.empty()) {
      read.why = kExpectedPoint;
    }
    return read;
  }
  read.name = krl_indexed_name(scanner->name(), scanner);
  if (read.name == "$NULLFRAME") {
    read.point = krl_point_at(Pose<double>{});
  } else {
    read.point = find_point(read.name);
  }
  return read;
}

KrlReadPoint KrlData::read_point(Scanner* scanner) const {
  KrlReadPoint read = read_operand(scanner);
  const auto computed = [&] {
    read.point.reset();
    read.why = fmt::format("'{}': a point that is computed cannot be told",
                           files::one_line(read.name.empty() ? "{...}" : read.name, 30));
    return read;
  };
  if (scanner->peek() == '[') {
    return computed();
  }
  while (read.why.empty() && scanner->take(':')) {
    const KrlReadPoint by = read_operand(scanner);
    if (!by.why.empty()) {
      read.why = by.why;
      return read;
    }
    const auto is_frame = [](const std::optional<KrlPoint>& each) {
      return each && each->is_whole() && !each->has_axes && !moves_external_axis(*each);
    };
    if (!is_frame(read.point) || !is_frame(by.point)) {
      return computed();
    }
    KrlPoint product = krl_point_at(read.point->pose() * by.point->pose());
    product.has_posture = by.point->has_posture;
    product.external = by.point->external;
    read.point = product;
  }
  return read;
}

KrlReadNumber KrlData::read_number(Scanner* scanner) const {
  KrlReadNumber read;
  read.number = scanner->number();
  if (read.number) {
    return read;
  }
  read.name = scanner->name();
  const auto found = numbers_.find(read.name);
  if (found != numbers_.end()) {
    read.number = found->second;
  }
  if (read.name.empty()) {
    read.why = fmt::format("expected a number or a name, found '{}'",
                           files::one_line(scanner->rest(), 30));
  } else if (found != numbers_.end() && !read.number) {
    read.why = fmt::format("'{}': a number that is computed cannot be told",
                           files::one_line(read.name, 30));
  }
  return read;
}

KrlFrame KrlData::numbered(const std::string& array, double number) const {
  KrlFrame frame;
  frame.name = fmt::format("{}[{:g}]", array, number);
  frame.is_loaded = true;
  if (number == 0) {
    frame.value = Pose<double>{};
    return frame;
  }
  const auto found = points_.find(frame.name);
  if (found != points_.end() && found->second.is_whole()) {
    frame.value = found->second.pose();
  }
  return frame;
}

KrlFrame KrlData::read_frame_name(const std::string& array, Scanner* scanner) const {
  if (const std::optional<double> number = scanner->number()) {
    return numbered(array, *number);
  }
  std::string name = scanner->name();
  if (name == array && scanner->take('[')) {
    if (const std::optional<double> index = scanner->number()) {
      scanner->take(']');
      return numbered(array, *index);
    }
  }
  name = name.substr(0, name.find('.'));
  const auto found = others_.find(name);
  if (found != others_.end()) {
    const KrlFrameData data = frame_data_of(found->second, name);
    return array == "BASE_DATA" ? data.base : data.tool;
  }
  KrlFrame unknown;
  unknown.name = name;
  unknown.is_loaded = true;
  return unknown;
}

KrlFrameData KrlData::frame_data_of(const std::vector<KrlComponent>& aggregate,
                                    const std::string& name) const {
  const auto frame = [&](const char* component, const char* array) {
    const KrlComponent* const number = component_of(aggregate, component);
    KrlFrame unknown;
    unknown.name = name;
    unknown.is_loaded = true;
    return number != nullptr && number->number ? numbered(array, *number->number) : unknown;
  };
  const KrlComponent* const ipo = component_of(aggregate, "IPO_FRAME");
  return {frame("TOOL_NO", "TOOL_DATA"), frame("BASE_NO", "BASE_DATA"),
          ipo != nullptr && ipo->word != "BASE"};
}

KrlFrameData KrlData::read_frame_data(Scanner* scanner) const {
  if (scanner->peek() == '{') {
    const std::optional<std::vector<KrlComponent>> aggregate = read_krl_aggregate(scanner);
    return frame_data_of(aggregate.value_or(std::vector<KrlComponent>{}), "FDAT_ACT");
  }
  const std::string name = scanner->name();
  const auto found = others_.find(name);
  return frame_data_of(found == others_.end() ? std::vector<KrlComponent>{} : found->second, name);
}

std::string KrlData::why_no_path(Scanner* scanner) const {
  std::optional<std::vector<KrlComponent>> aggregate;
  if (scanner->peek() == '{') {
    aggregate = read_krl_aggregate(scanner);
  } else {
    const auto found = others_.find(scanner->name());
    if (found == others_.end()) {
      return {};
    }
    aggregate = found->second;
  }
  if (!aggregate) {
    return "expected an LDAT in numbers";
  }
  const KrlComponent* const turn = component_of(*aggregate, "ORI_TYP");
  const KrlComponent* const circle = component_of(*aggregate, "CIRC_TYP");
  if (turn != nullptr && turn->word != "VAR") {
    return fmt::format(
        "ORI_TYP #{}: an orientation that does not go from point to point is not "
        "read",
        files::one_line(turn->word, 30));
  }
  if (circle != nullptr && circle->word != "BASE") {
    return fmt::format("CIRC_TYP #{}: an orientation that follows the circle is not read",
                       files::one_line(circle->word, 30));
  }
  return {};
}

}  // namespace flexcomp::programs
