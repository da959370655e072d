#include "model/urdf_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "error.hpp"
#include "files/one_line.hpp"
#include "model/edit_distance.hpp"
#include "model/whole_turn.hpp"

namespace flexcomp::model {
namespace {

using Names = std::vector<std::string_view>;

/// Parts of a joint or a link according to the standard.
const Names kJointParts = {"origin", "parent",      "child",
                           "axis",   "calibration", "dynamics",
                           "limit",  "mimic",       "safety_controller"};
const Names kLinkParts = {"inertial", "visual", "collision"};
const Names kInertialParts = {"origin", "mass", "inertia"};

/// Elements that flexcomp reads, and that say nothing where they do not belong.
const Names kRead = {"inertial", "origin", "mass", "inertia", "axis", "limit"};

bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The name that `found` is a slip of the pen of; empty if there is none.
std::string_view meant_by(std::string_view found, const Names& names) {
  for (const std::string_view name : names) {
    if (3 * edit_distance(found, name) <= name.size()) {
      return name;
    }
  }
  return {};
}

/// A finite decimal number and nothing else, which is what urdfdom can read.
std::optional<double> decimal_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') {
    word.remove_prefix(1);
  }
  double value = 0;
  const char* const begin = word.data();
  const char* const end = begin + word.size();
  const auto read = std::from_chars(begin, end, value);
  const bool is_number = read.ec == std::errc{} && read.ptr == end && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

/// Words between spaces; other white space separates nothing for urdfdom.
std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.empty()) {
      return all;
    }
    const std::string_view word = text.substr(0, text.find(' '));
    all.push_back(word);
    text.remove_prefix(word.size());
  }
}

class ValueCheck {
 public:
  explicit ValueCheck(const std::string& file) : file_(file) {}

  void check_robot(const TiXmlElement& robot) const {
    for (const TiXmlElement* part = robot.FirstChildElement(); part != nullptr;
         part = part->NextSiblingElement()) {
      if (contains(kRead, part->ValueStr())) {
        fail(*part, "does not belong here; expected it in a link or joint");
      }
      if (part->ValueStr() == "link") {
        check_link(*part);
      } else if (part->ValueStr() == "joint") {
        check_joint(*part);
      }
    }
  }

 private:
  [[noreturn]] void fail(const TiXmlElement& element, const std::string& why) const {
    std::string place = fmt::format("<{}>: ", files::one_line(element.ValueStr()));
    for (const TiXmlNode* node = &element; node != nullptr; node = node->Parent()) {
      const bool has_name = node->ValueStr() == "link" || node->ValueStr() == "joint";
      const char* const name = has_name ? node->ToElement()->Attribute("name") : nullptr;
      if (name != nullptr) {
        place = fmt::format("{} '{}': {}", node->ValueStr(), files::one_line(name),
                            node == &element ? "" : place);
      }
    }
    throw InputError(fmt::format("{}:{}: {}{}", file_, element.Row(), place, why));
  }

  void check_link(const TiXmlElement& link) const {
    check_parts(link, kLinkParts, {"inertial"});
    if (const TiXmlElement* inertial = link.FirstChildElement("inertial")) {
      check_inertial(*inertial);
    }
  }

  void check_inertial(const TiXmlElement& inertial) const {
    for (const TiXmlElement* part = inertial.FirstChildElement(); part != nullptr;
         part = part->NextSiblingElement()) {
      if (!contains(kInertialParts, part->ValueStr())) {
        fail(*part, "unknown in an <inertial>; expected <origin>, <mass> or <inertia>");
      }
    }
    check_parts(inertial, kInertialParts, kInertialParts);
    check_origin(inertial);
    check_only_attributes(required(inertial, "mass"), {"value"});
    number(required(inertial, "mass"), "value");
    const Names moments = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    const TiXmlElement& inertia = required(inertial, "inertia");
    check_only_attributes(inertia, moments);
    for (const std::string_view moment : moments) {
      number(inertia, moment);
    }
  }

  void check_joint(const TiXmlElement& joint) const {
    check_parts(joint, kJointParts, kJointParts);
    check_origin(joint);
    const std::string type = text(joint, "type");
    const bool turns = type == "revolute" || type == "continuous";
    if (!turns && type != "prismatic") {
      return;  // what else it may say of its motion is of no account
    }
    const TiXmlElement& axis = required(joint, "axis");
    check_only_attributes(axis, {"xyz"});
    numbers(axis, "xyz", 3);
    if (type != "continuous") {
      check_limit(required(joint, "limit"), "");
    } else if (const TiXmlElement* const limit = joint.FirstChildElement("limit")) {
      check_limit(*limit, "lower upper");  // it has none, whatever stands there
    }
  }

  /// `optional` names the attributes that may be left out.
  void check_limit(const TiXmlElement& limit, std::string_view optional) const {
    const Names known = {"lower", "upper", "effort", "velocity"};
    for (const TiXmlAttribute* each = limit.FirstAttribute(); each != nullptr;
         each = each->Next()) {
      refuse_slip(limit, each->Name(), known);
    }
    for (const std::string_view name : known) {
      const bool is_required = optional.find(name) == std::string_view::npos;
      if (is_required || limit.Attribute(std::string(name).c_str()) != nullptr) {
        number(limit, name);
      }
    }
  }

  void check_origin(const TiXmlElement& of) const {
    const TiXmlElement* const origin = of.FirstChildElement("origin");
    if (origin == nullptr) {
      return;
    }
    check_only_attributes(*origin, {"xyz", "rpy"});
    if (origin->Attribute("xyz") != nullptr) {
      numbers(*origin, "xyz", 3);
    }
    if (origin->Attribute("rpy") == nullptr) {
      return;
    }
    for (const double angle : numbers(*origin, "rpy", 3)) {
      if (is_beyond_a_turn(angle)) {
        fail(*origin, fmt::format("rpy: expected radians, found {:g}, more than a whole turn; are "
                                  "these degrees?",
                                  angle));
      }
    }
  }

  /// Refuses a part that is misspelt, stands in the wrong element, or stands twice although it is
  /// one of `single`.
  void check_parts(const TiXmlElement& whole, const Names& known, const Names& single) const {
    std::set<std::string> seen;
    for (const TiXmlElement* part = whole.FirstChildElement(); part != nullptr;
         part = part->NextSiblingElement()) {
      const std::string& name = part->ValueStr();
      if (contains(kRead, name) && !contains(known, name)) {
        fail(*part, fmt::format("does not belong into a <{}>", whole.ValueStr()));
      }
      refuse_slip(*part, name, known);
      if (!seen.insert(name).second && contains(single, name)) {
        fail(*part, "appears twice");
      }
    }
  }

  void refuse_slip(const TiXmlElement& at, std::string_view found, const Names& known) const {
    const std::string_view meant = contains(known, found) ? "" : meant_by(found, known);
    if (!meant.empty()) {
      fail(at, fmt::format("'{}' is unknown; did you mean '{}'?", files::one_line(found), meant));
    }
  }

  void check_only_attributes(const TiXmlElement& element, const Names& known) const {
    for (const TiXmlAttribute* each = element.FirstAttribute(); each != nullptr;
         each = each->Next()) {
      if (!contains(known, each->Name())) {
        fail(element, fmt::format("'{}' is unknown; expected {}", files::one_line(each->Name()),
                                  fmt::join(known, ", ")));
      }
    }
  }

  const TiXmlElement& required(const TiXmlElement& whole, const char* part) const {
    const TiXmlElement* const element = whole.FirstChildElement(part);
    if (element == nullptr) {
      fail(whole, fmt::format("<{}> is missing", part));
    }
    return *element;
  }

  std::string text(const TiXmlElement& element, std::string_view attribute) const {
    const char* const value = element.Attribute(std::string(attribute).c_str());
    if (value == nullptr) {
      fail(element, fmt::format("'{}' is missing", attribute));
    }
    return value;
  }

  double number(const TiXmlElement& element, std::string_view attribute) const {
    const std::string written = text(element, attribute);
    const std::optional<double> value = decimal_number(written);
    if (!value) {
      fail(element, fmt::format("{}: expected a finite number, found '{}'", attribute,
                                files::one_line(written)));
    }
    return *value;
  }

  std::vector<double> numbers(const TiXmlElement& element, std::string_view attribute,
                              std::size_t count) const {
    const std::string written = text(element, attribute);
    std::vector<double> values;
    for (const std::string_view word : words(written)) {
      values.push_back(decimal_number(word).value_or(std::nan("")));
    }
    const bool all_finite = std::all_of(values.begin(), values.end(),
                                        [](double value) { return std::isfinite(value); });
    if (values.size() != count || !all_finite) {
      fail(element, fmt::format("{}: expected {} finite numbers between spaces, found '{}'",
                                attribute, count, files::one_line(written)));
    }
    return values;
  }

  const std::string& file_;
};

}  // namespace

void refuse_unreadable_values(const std::string& file, const TiXmlDocument& document) {
  const TiXmlElement* const robot = document.FirstChildElement("robot");
  if (robot == nullptr) {
    return;  // urdfdom says so
  }
  if (const TiXmlElement* const second = robot->NextSiblingElement("robot")) {
    throw InputError(fmt::format("{}:{}: <robot>: appears twice", file, second->Row()));
  }
  ValueCheck(file).check_robot(*robot);
}

}  // namespace flexcomp::model
