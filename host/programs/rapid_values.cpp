#include "programs/rapid_values.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "files/one_line.hpp"
#include "programs/program.hpp"

namespace flexcomp::programs {
namespace {

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

/// Offs(p,x,y,z) in the work object's axes, RelTool(p,x,y,z) in the tool's.
std::optional<Pose<double>> moved(const RapidData& data, Scanner* scanner, bool is_by_tool,
                                  int depth) {
  if (!scanner->take('(')) {
    return std::nullopt;
  }
  std::optional<Pose<double>> pose = data.target(scanner, depth + 1);
  Vector3<double> by;
  for (double& each : by) {
    const std::optional<double> number = scanner->take(',') ? scanner->number() : std::nullopt;
    if (!number) {
      return std::nullopt;
    }
    each = kMillimetre * *number;
  }
  if (!pose || !scanner->take(')')) {
    return std::nullopt;
  }
  pose->position += is_by_tool ? Vector3<double>(pose->rotation * by) : by;
  return pose;
}

/// v100 is 100 mm/s, vmax as fast as it goes.
std::optional<double> speed_by_name(const std::string& name) {
  if (name.size() < 2 || name[0] != 'V') {
    return std::nullopt;
  }
  Scanner digits(std::string_view(name).substr(1));
  const std::optional<double> number = digits.number();
  return number && digits.at_end() && *number > 0 ? std::optional<double>(kMillimetre * *number)
                                                  : std::nullopt;
}

}  // namespace

std::optional<std::vector<double>> read_rapid_numbers(Scanner* scanner) {
  std::vector<double> numbers;
  int depth = 0;
  do {
    if (scanner->take('[')) {
      ++depth;
    } else if (scanner->take(']')) {
      --depth;
      if (depth > 0) {
        scanner->take(',');
      }
    } else if (scanner->take('"')) {
      const std::size_t close = scanner->rest().find('"');
      if (close == std::string_view::npos) {
        return std::nullopt;
      }
      scanner->go_to(scanner->place() + close + 1);
      scanner->take(',');
    } else if (const std::optional<double> number = scanner->number()) {
      numbers.push_back(*number);
      scanner->take(',');
    } else {
      const std::string word = scanner->name();
      if (word != "TRUE" && word != "FALSE") {
        return std::nullopt;
      }
      scanner->take(',');
    }
  } while (depth > 0 && numbers.size() < 1000);
  return numbers;
}

std::string rapid_configuration(std::string_view target) {
  std::size_t at = target.find(']');
  at = at == std::string_view::npos ? at : target.find(']', at + 1);
  const std::size_t end = target.rfind(']');
  if (at == std::string_view::npos || end <= at + 1 ||
      target.substr(at + 1).find('[') == std::string_view::npos) {
    return ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]";
  }
  return files::one_line(target.substr(at + 1, end - at - 1), 200);
}

bool RapidData::read_declaration(std::string word, Scanner* scanner) {
  static const std::set<std::string> kBefore = {"LOCAL", "TASK", "CONST", "PERS", "VAR"};
  if (kBefore.count(word) == 0) {
    return false;
  }
  while (kBefore.count(word) > 0) {
    word = scanner->name();
  }
  const std::string name = scanner->name();
  if (!scanner->take(':') || !scanner->take('=')) {
    return true;
  }
  if (word == "ROBTARGET") {
    configurations[name] = rapid_configuration(scanner->rest());
    if (const auto pose = target(scanner)) {
      targets[name] = *pose;
    }
    return true;
  }
  const std::optional<std::vector<double>> numbers = read_rapid_numbers(scanner);
  if (numbers && word == "SPEEDDATA" && !numbers->empty() && numbers->front() > 0) {
    speeds[name] = kMillimetre * numbers->front();
  }
  if (numbers && word == "WOBJDATA") {
    const auto user = pose_of(*numbers, 0);
    const auto object = pose_of(*numbers, 7);
    if (user && object) {
      frames[name] = *user * *object;
    }
  }
  return true;
}

std::optional<Pose<double>> RapidData::target(Scanner* scanner, int depth) const {
  constexpr int kDeepest = 8;
  if (scanner->peek() == '[') {
    const std::optional<std::vector<double>> numbers = read_rapid_numbers(scanner);
    return numbers ? pose_of(*numbers, 0) : std::nullopt;
  }
  const std::string name = scanner->name();
  if ((name == "OFFS" || name == "RELTOOL") && depth < kDeepest) {
    return moved(*this, scanner, name == "RELTOOL", depth);
  }
  const auto found = targets.find(name);
  const bool is_element = scanner->peek() == '{' || scanner->peek() == '(';
  return found != targets.end() && !is_element && name.find('.') == std::string::npos
             ? std::optional<Pose<double>>(found->second)
             : std::nullopt;
}

std::optional<double> RapidData::speed(Scanner* scanner) const {
  if (scanner->peek() == '[') {
    const std::optional<std::vector<double>> numbers = read_rapid_numbers(scanner);
    return numbers && !numbers->empty() && numbers->front() > 0
               ? std::optional<double>(kMillimetre * numbers->front())
               : std::nullopt;
  }
  const std::string name = scanner->name();
  const auto found = speeds.find(name);
  return found != speeds.end() ? std::optional<double>(found->second) : speed_by_name(name);
}

}  // namespace flexcomp::programs
