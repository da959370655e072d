#include "programs/gcode_axes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string_view>

namespace flexcomp::programs {
namespace {

constexpr std::string_view kAxisLetters = "XYZABC";

}  // namespace

void GcodeAxes::go(const GcodeLine& line, const GcodeModes& modes) {
  for (std::size_t axis = 0; axis < kCount; ++axis) {
    const char letter = kAxisLetters[axis];
    if (!line.has(letter)) {
      continue;
    }
    const bool is_place = axis < 3;
    double& value = (is_place ? at_ : turn_)[static_cast<Eigen::Index>(axis % 3)];
    const double given = (is_place ? modes.unit : kDegree) * line.value(letter);
    Knowledge& of = axes_[axis];
    value = modes.is_relative ? value + given : given;
    of.is_known = of.is_known || !modes.is_relative;
    of.is_told = true;
  }
}

void GcodeAxes::lose_named(const GcodeLine& line, std::size_t number) {
  const bool names_some = line.has_any(kAxisLetters);
  for (std::size_t axis = 0; axis < kCount; ++axis) {
    if (names_some ? line.has(kAxisLetters[axis]) : axes_[axis].is_told) {
      lose(axis, number, "goes to a place of the machine");
    }
  }
}

void GcodeAxes::lose_tip(std::size_t number) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lose(axis, number, "changes the tool");
  }
}

void GcodeAxes::lose(std::size_t axis, std::size_t number, const char* by) {
  axes_[axis].is_known = false;
  axes_[axis].lost_in = number;
  axes_[axis].lost_by = by;
}

std::size_t GcodeAxes::first_unknown() const {
  std::size_t axis = 0;
  while (axis < kCount && axes_[axis].is_known) {
    ++axis;
  }
  return axis;
}

std::string GcodeAxes::why_unknown() const {
  const std::size_t axis = first_unknown();
  const Knowledge& of = axes_[axis];
  const std::string why = of.lost_in == 0 ? std::string("no line before tells it")
                                          : fmt::format("line {} {}", of.lost_in, of.lost_by);
  return fmt::format("{} is not known: {}", kAxisLetters[axis], why);
}

Matrix3<double> GcodeAxes::orientation() const {
  using Eigen::AngleAxisd;
  using Vector = Vector3<double>;
  return (AngleAxisd(turn_[2], Vector::UnitZ()) * AngleAxisd(turn_[1], Vector::UnitY()) *
          AngleAxisd(turn_[0], Vector::UnitX()))
             .toRotationMatrix() *
         orientation_by_axis(Vector::UnitZ());
}

}  // namespace flexcomp::programs
