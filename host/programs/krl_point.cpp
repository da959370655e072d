#include "programs/krl_point.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "programs/program.hpp"

namespace flexcomp::programs {
namespace {

/// Passes over a value that is no number: an enumeration (#NONE), a truth value, a text in marks.
bool pass_value(Scanner* scanner) {
  scanner->take('#');
  if (scanner->take('"')) {
    const std::size_t close = scanner->rest().find('"');
    if (close == std::string_view::npos) {
      return false;
    }
    scanner->go_to(scanner->place() + close + 1);
    return true;
  }
  return !scanner->name().empty();
}

}  // namespace

std::string_view krl_code(std::string_view line) {
  bool is_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    is_text = is_text != (line[i] == '"');
    if (line[i] == ';' && !is_text) {
      return line.substr(0, i);
    }
  }
  return line;
}

bool KrlPoint::is_whole() const {
  return std::all_of(frame.begin(), frame.end(), [](const auto& each) { return each.has_value(); });
}

void KrlPoint::fill_from(const KrlPoint& other) {
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!frame[i]) {
      frame[i] = other.frame[i];
    }
  }
}

Pose<double> KrlPoint::pose() const {
  using Eigen::AngleAxisd;
  using Vector = Vector3<double>;
  return {(AngleAxisd(*frame[3] * kDegree, Vector::UnitZ()) *
           AngleAxisd(*frame[4] * kDegree, Vector::UnitY()) *
           AngleAxisd(*frame[5] * kDegree, Vector::UnitX()))
              .toRotationMatrix(),
          kMillimetre * Vector(*frame[0], *frame[1], *frame[2])};
}

std::optional<KrlPoint> read_krl_point(Scanner* scanner) {
  if (!scanner->take('{')) {
    return std::nullopt;
  }
  KrlPoint point;
  constexpr std::string_view kNames = "XYZABC";
  while (!scanner->take('}')) {
    const std::string name = scanner->name();
    if (name.empty()) {
      return std::nullopt;
    }
    if (scanner->take(':')) {  // the type's name
      continue;
    }
    const std::optional<double> value = scanner->number();
    if (!value && !pass_value(scanner)) {
      return std::nullopt;
    }
    const std::size_t at = name.size() == 1 ? kNames.find(name[0]) : std::string_view::npos;
    if (at != std::string_view::npos) {
      if (!value || std::abs(*value) > 1e9) {
        return std::nullopt;
      }
      point.frame[at] = value;
    }
    point.has_axes = point.has_axes || (name.size() == 2 && name[0] == 'A');
    if (!scanner->take(',') && scanner->peek() != '}') {
      return std::nullopt;
    }
  }
  return point;
}

std::array<double, 3> krl_angles(const Matrix3<double>& rotation) {
  const double across = std::hypot(rotation(0, 0), rotation(1, 0));
  const double b = std::atan2(-rotation(2, 0), across);
  const bool is_upright = across < 1e-9;
  const double a = is_upright ? 0 : std::atan2(rotation(1, 0), rotation(0, 0));
  const double c = is_upright ? std::atan2(-rotation(1, 2), rotation(1, 1))
                              : std::atan2(rotation(2, 1), rotation(2, 2));
  return {a / kDegree, b / kDegree, c / kDegree};
}

}  // namespace flexcomp::programs
