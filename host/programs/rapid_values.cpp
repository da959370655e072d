#include "programs/rapid_values.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "files/one_line.hpp"
#include "programs/program.hpp"
#include "programs/rapid_statements.hpp"
#include "programs/rapid_words.hpp"

namespace flexcomp::programs {
namespace {

constexpr int kDeepest = 8;  // of what stands in each other
constexpr std::size_t kJoints = 6;
constexpr double kNoAxis = 9e9;  // an external axis that is none
const std::set<std::string> kDeclaring = {"LOCAL", "TASK", "CONST", "PERS", "VAR"};

/// Three numbers of a place in mm and four of a quaternion from `first` on.
std::optional<Pose<double>> pose_of(const std::vector<double>& numbers, std::size_t first) {
  if (numbers.size() < first + 7) {
    return std::nullopt;
  }
  const double* const at = numbers.data() + first;
  const Eigen::Quaterniond turn(at[3], at[4], at[5], at[6]);
  const Vector3<double> place = kMillimetre * Vector3<double>(at[0], at[1], at[2]);
  const double length = turn.norm();
  if (!(length > 0.5 && length < 2) || !(place.cwiseAbs().maxCoeff() < 1e6)) {
    return std::nullopt;
  }
  return Pose<double>{turn.normalized().toRotationMatrix(), place};
}

/// External axes from `first` on.
RapidAxes axes_of(const std::vector<double>& numbers, std::size_t first) {
  RapidAxes axes;
  axes.fill(kNoAxis);
  for (std::size_t i = 0; i < axes.size() && first + i < numbers.size(); ++i) {
    axes[i] = numbers[first + i];
  }
  return axes;
}

std::optional<RapidTarget> target_of(const std::vector<double>& numbers) {
  const std::optional<Pose<double>> pose = pose_of(numbers, 0);
  if (!pose) {
    return std::nullopt;
  }
  RapidTarget target;
  target.pose = *pose;
  constexpr std::size_t kTurns = 7;  // behind place and quaternion
  constexpr std::size_t kAxes = 11;  // behind those four
  for (std::size_t i = kTurns; i < std::min(numbers.size(), kAxes); ++i) {
    target.has_configuration = target.has_configuration || numbers[i] != 0;
  }
  target.external = axes_of(numbers, kAxes);
  return target;
}

/// v100 is 100 mm/s, and 500 degrees a second as they all are; vmax is as fast as it goes.
std::optional<RapidSpeed> speed_by_name(const std::string& name) {
  if (name.size() < 2 || name[0] != 'V') {
    return std::nullopt;
  }
  Scanner digits(std::string_view(name).substr(1));
  const std::optional<double> number = digits.number();
  return number && digits.at_end() && *number > 0
             ? std::optional<RapidSpeed>({kMillimetre * *number, kFastestRapidTurn})
             : std::nullopt;
}

std::optional<RapidSpeed> speed_in(const std::optional<std::vector<double>>& numbers) {
  if (!numbers || numbers->empty() || !(numbers->front() > 0)) {
    return std::nullopt;
  }
  const double turn = numbers->size() > 1 ? std::max((*numbers)[1], 0.0) : 0;
  return RapidSpeed{kMillimetre * numbers->front(), kDegree * turn};
}

}  // namespace

void RapidData::read_all(std::string_view text) {
  RapidStatements statements(text);
  RapidStatement statement;
  while (statements.next(&statement)) {
    Scanner scanner(statement.text);
    if (!read_declaration(scanner.name(), &scanner)) {
      note_changes(statement.text);
    }
  }
  for (const std::string& name : changed_) {
    numbers.erase(name);
    joints.erase(name);
    speeds.erase(name);
    if (work_objects.count(name) > 0) {
      work_objects[name].why = "the program changes this work object";
    }
    if (tools.count(name) > 0) {
      tools[name] = false;
    }
  }
}

/// Names that a statement sets: before `:=`, behind FOR and INCR, and parameters, which hide
/// others. What `:=` gives to an option (\WObj:=) is none of these.
void RapidData::note_changes(const std::string& statement) {
  static const std::set<std::string> kNext = {"FOR", "INCR", "DECR", "ADD", "CLEAR"};
  Scanner scanner(statement);
  std::string word = scanner.name();
  if (word == "LOCAL") {
    word = scanner.name();
  }
  const bool takes_all = begins_rapid_routine(word);
  if (kNext.count(word) > 0) {
    const std::string name = scanner.name();
    changed_.insert(name.substr(0, name.find('.')));
  }
  bool is_option = false;
  for (std::string last = word; !scanner.at_end();) {
    const bool is_assignment = scanner.take(':') && scanner.take('=');
    if ((is_assignment && !is_option) || takes_all) {
      changed_.insert(last.substr(0, last.find('.')));
    }
    const bool is_marked = scanner.take('\\');
    const std::string name = scanner.name();
    if (!name.empty()) {
      last = name;
      is_option = is_marked;
    } else if (!is_assignment && !scanner.at_end()) {
      scanner.go_to(scanner.place() + 1);
    }
  }
}

bool RapidData::read_declaration(std::string word, Scanner* scanner) {
  if (kDeclaring.count(word) == 0) {
    return false;
  }
  const Scanner begin = *scanner;
  while (kDeclaring.count(word) > 0) {
    word = scanner->name();
  }
  if (begins_rapid_routine(word)) {
    *scanner = begin;
    return false;
  }
  const std::string name = scanner->name();
  const auto declared = declared_.emplace(name, scanner->rest());
  if (!declared.second && declared.first->second != scanner->rest()) {  // which one is meant?
    targets.erase(name);
    changed_.insert(name);
    return true;
  }
  if (word == "ROBTARGET") {
    declare_targets(name, scanner);
  } else if (scanner->take(':') && scanner->take('=')) {
    declare(word, name, scanner);
  }
  return true;
}

/// One target, or those of an array with one dimension.
void RapidData::declare_targets(const std::string& name, Scanner* scanner) {
  const auto take = [&](const std::string& each) {
    const std::size_t begin = scanner->place();
    const std::string_view text = scanner->rest();
    const std::optional<RapidTarget> value = target(scanner);
    configurations[each] = rapid_configuration(text.substr(0, scanner->place() - begin));
    if (value) {
      targets[each] = *value;
    }
    return value.has_value();
  };
  const bool is_array = scanner->take('{');
  const bool has_one_dimension = is_array && scanner->number() && scanner->take('}');
  if (!(scanner->take(':') && scanner->take('=')) || is_array != has_one_dimension) {
    return;
  }
  if (!is_array) {
    take(name);
    return;
  }
  scanner->take('[');
  for (int i = 1; take(fmt::format("{}{{{}}}", name, i)) && scanner->take(',');) {
    ++i;
  }
}

void RapidData::declare(const std::string& type, const std::string& name, Scanner* scanner) {
  if (changed_.count(name) > 0) {
    return;
  }
  if (type == "NUM") {
    const std::optional<double> value = number(scanner);
    if (value && scanner->at_end()) {
      numbers[name] = *value;
    }
    return;
  }
  const std::string_view text = scanner->rest();
  const std::optional<std::vector<double>> values = read_rapid_numbers(scanner);
  const std::optional<RapidSpeed> speed = type == "SPEEDDATA" ? speed_in(values) : std::nullopt;
  if (speed) {
    speeds[name] = *speed;
  } else if (values && type == "JOINTTARGET") {
    joints[name] = axes_of(*values, kJoints);
  } else if (values && type == "WOBJDATA") {
    declare_work_object(name, *values, text);
  } else if (type == "TOOLDATA") {
    Scanner held(text);
    held.take('[');
    tools[name] = held.name() == "TRUE";
  }
}

/// [robhold, ufprog, ufmec, user frame, object frame].
void RapidData::declare_work_object(const std::string& name, const std::vector<double>& values,
                                    std::string_view text) {
  const auto user = pose_of(values, 0);
  const auto object = pose_of(values, 7);
  if (!user || !object) {
    return;
  }
  Scanner scanner(text);
  scanner.take('[');
  const bool is_held = scanner.name() != "FALSE";
  scanner.take(',');
  const bool is_fixed = scanner.name() == "TRUE";
  work_objects[name] = {*user * *object, is_held ? "the robot holds this work object (robhold)"
                                         : is_fixed
                                             ? ""
                                             : "a mechanical unit moves this work object (ufprog)"};
}

void RapidData::forget_target(const std::string& name) {
  const std::string whole = name.substr(0, name.find('.'));
  targets.erase(whole);
  for (auto each = targets.lower_bound(whole + "{");
       each != targets.end() && each->first.compare(0, whole.size() + 1, whole + "{") == 0;) {
    each = targets.erase(each);
  }
}

std::optional<std::string> RapidData::target_name(Scanner* scanner) const {
  std::string name = scanner->name();
  if (scanner->take('{')) {
    const std::optional<double> index = number(scanner);
    if (!index || !scanner->take('}')) {
      return std::nullopt;
    }
    name += fmt::format("{{{:g}}}", *index);
  }
  return name;
}

std::optional<RapidTarget> RapidData::target(Scanner* scanner, int depth) const {
  if (scanner->peek() == '[') {
    const std::optional<std::vector<double>> values = read_rapid_numbers(scanner);
    return values ? target_of(*values) : std::nullopt;
  }
  const std::optional<std::string> name = target_name(scanner);
  if (!name) {
    return std::nullopt;
  }
  if ((name == "OFFS" || name == "RELTOOL") && depth < kDeepest) {
    return moved(scanner, name == "RELTOOL", depth);
  }
  const auto found = targets.find(*name);
  const bool is_more = scanner->peek() == '{' || scanner->peek() == '(';
  return found != targets.end() && !is_more && name->find('.') == std::string::npos
             ? std::optional<RapidTarget>(found->second)
             : std::nullopt;
}

std::optional<RapidAxes> RapidData::joint_axes(Scanner* scanner) const {
  if (scanner->peek() == '[') {
    const std::optional<std::vector<double>> values = read_rapid_numbers(scanner);
    return values ? std::optional<RapidAxes>(axes_of(*values, kJoints)) : std::nullopt;
  }
  const auto found = joints.find(scanner->name());
  return found != joints.end() && scanner->peek() != '{' ? std::optional<RapidAxes>(found->second)
                                                         : std::nullopt;
}

/// Offs(p,x,y,z) in the work object's axes, RelTool(p,x,y,z\Rx:=…\Ry:=…\Rz:=…) in the tool's.
std::optional<RapidTarget> RapidData::moved(Scanner* scanner, bool is_by_tool, int depth) const {
  if (!scanner->take('(')) {
    return std::nullopt;
  }
  std::optional<RapidTarget> to = target(scanner, depth + 1);
  Vector3<double> by;
  for (double& each : by) {
    const std::optional<double> value = scanner->take(',') ? number(scanner) : std::nullopt;
    if (!value) {
      return std::nullopt;
    }
    each = kMillimetre * *value;
  }
  Matrix3<double> rotation = Matrix3<double>::Identity();
  if (!to || (is_by_tool && !turn(scanner, &rotation)) || !scanner->take(')') ||
      !(by.cwiseAbs().maxCoeff() < 1e6)) {
    return std::nullopt;
  }
  to->pose.position += is_by_tool ? Vector3<double>(to->pose.rotation * by) : by;
  to->pose.rotation = to->pose.rotation * rotation;
  return to;
}

/// Degrees about x, then the new y, then the new z, in whatever order they are written.
bool RapidData::turn(Scanner* scanner, Matrix3<double>* rotation) const {
  std::array<double, 3> angles{};
  while (scanner->take('\\')) {
    const std::string name = scanner->name();
    const bool is_about = name.size() == 2 && name[0] == 'R' && name[1] >= 'X' && name[1] <= 'Z';
    const std::optional<double> angle =
        is_about && scanner->take(':') && scanner->take('=') ? number(scanner) : std::nullopt;
    if (!angle) {
      return false;
    }
    angles[static_cast<std::size_t>(name[1] - 'X')] = *angle * kDegree;
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    *rotation =
        *rotation * Eigen::AngleAxisd(angles[static_cast<std::size_t>(i)], Vector3<double>::Unit(i))
                        .toRotationMatrix();
  }
  return true;
}

std::optional<double> RapidData::number(Scanner* scanner, int depth) const {
  std::optional<double> sum = product(scanner, depth);
  while (sum && (scanner->peek() == '+' || scanner->peek() == '-')) {
    const double sign = scanner->take('-') ? -1 : 1;
    scanner->take('+');
    const std::optional<double> next = product(scanner, depth);
    sum = next ? std::optional<double>(*sum + sign * *next) : std::nullopt;
  }
  return sum && std::isfinite(*sum) ? sum : std::nullopt;
}

std::optional<double> RapidData::product(Scanner* scanner, int depth) const {
  std::optional<double> all = factor(scanner, depth);
  while (all && (scanner->peek() == '*' || scanner->peek() == '/')) {
    const bool divides = scanner->take('/');
    scanner->take('*');
    const std::optional<double> next = factor(scanner, depth);
    all = next ? std::optional<double>(divides ? *all / *next : *all * *next) : std::nullopt;
  }
  return all;
}

std::optional<double> RapidData::factor(Scanner* scanner, int depth) const {
  if (const std::optional<double> value = scanner->number()) {
    return value;
  }
  const double sign = scanner->take('-') ? -1 : 1;
  if (scanner->take('(')) {
    const std::optional<double> inside =
        depth < kDeepest ? number(scanner, depth + 1) : std::nullopt;
    return inside && scanner->take(')') ? std::optional<double>(sign * *inside) : std::nullopt;
  }
  const auto found = numbers.find(scanner->name());
  return found != numbers.end() && scanner->peek() != '{' && scanner->peek() != '('
             ? std::optional<double>(sign * found->second)
             : std::nullopt;
}

std::optional<RapidSpeed> RapidData::speed(Scanner* scanner) const {
  if (scanner->peek() == '[') {
    return speed_in(read_rapid_numbers(scanner));
  }
  const std::string name = scanner->name();
  const auto found = speeds.find(name);
  return found != speeds.end() ? std::optional<RapidSpeed>(found->second) : speed_by_name(name);
}

}  // namespace flexcomp::programs
