#include "recording/foreign_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <vector>

#include "error.hpp"
#include "files/one_line.hpp"

namespace flexcomp::recording {
namespace {

enum class Dimension { time, angle, length, force, torque, temperature };

struct Unit {
  std::string_view name;
  Dimension dimension;
  Scale scale;
};

constexpr double kDegree = 0.017453292519943295;  // rad
constexpr double kTurn = 6.283185307179586;       // rad
constexpr double kInch = 0.0254;                  // m
constexpr double kPound = 4.4482216152605;        // N, of force
constexpr double kIcePoint = 273.15;              // K

constexpr std::array<Unit, 25> kUnits = {{
    {"s", Dimension::time, {}},
    {"ms", Dimension::time, {1e-3, 0}},
    {"us", Dimension::time, {1e-6, 0}},
    {"ns", Dimension::time, {1e-9, 0}},
    {"rad", Dimension::angle, {}},
    {"mrad", Dimension::angle, {1e-3, 0}},
    {"urad", Dimension::angle, {1e-6, 0}},
    {"deg", Dimension::angle, {kDegree, 0}},
    {"turn", Dimension::angle, {kTurn, 0}},
    {"m", Dimension::length, {}},
    {"mm", Dimension::length, {1e-3, 0}},
    {"um", Dimension::length, {1e-6, 0}},
    {"in", Dimension::length, {kInch, 0}},
    {"N", Dimension::force, {}},
    {"kN", Dimension::force, {1e3, 0}},
    {"lbf", Dimension::force, {kPound, 0}},
    {"Nm", Dimension::torque, {}},
    {"N·m", Dimension::torque, {}},
    {"mNm", Dimension::torque, {1e-3, 0}},
    {"kNm", Dimension::torque, {1e3, 0}},
    {"Nmm", Dimension::torque, {1e-3, 0}},
    {"lbfin", Dimension::torque, {kPound * kInch, 0}},
    {"C", Dimension::temperature, {}},
    {"K", Dimension::temperature, {1, -kIcePoint}},
    {"F", Dimension::temperature, {5.0 / 9, -160.0 / 9}},
}};

std::vector<Dimension> dimensions_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return {Dimension::time};
    case Quantity::joint:
      return {Dimension::angle, Dimension::length};
    case Quantity::drive:
      return {Dimension::torque, Dimension::force};
    case Quantity::force:
      return {Dimension::force};
    case Quantity::torque:
      return {Dimension::torque};
    case Quantity::length:
      return {Dimension::length};
    case Quantity::temperature:
      return {Dimension::temperature};
    case Quantity::line:
      break;
  }
  return {};
}

[[noreturn]] void refuse(const std::string& unit, Quantity quantity) {
  std::string expected;
  for (const Dimension dimension : dimensions_of(quantity)) {
    for (const Unit& known : kUnits) {
      if (known.dimension == dimension) {
        expected += (expected.empty() ? "" : ", ") + std::string(known.name);
      }
    }
  }
  throw InputError(fmt::format("unit '{}': expected {}", files::one_line(unit),
                               expected.empty() ? "none" : expected));
}

Scale scale_of_unit(const std::string& unit, Quantity quantity) {
  if (unit.empty()) {
    return {};
  }
  const std::vector<Dimension> dimensions = dimensions_of(quantity);
  for (const Unit& known : kUnits) {
    if (known.name == unit &&
        std::find(dimensions.begin(), dimensions.end(), known.dimension) != dimensions.end()) {
      return known.scale;
    }
  }
  refuse(unit, quantity);
}

/// Takes a number from the front of `text`; NaN, and nothing taken, where there is none.
double take_number(std::string_view* text) {
  double number = 0;
  const auto [read, error] = std::from_chars(text->data(), text->data() + text->size(), number);
  if (error != std::errc{}) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  text->remove_prefix(static_cast<std::size_t>(read - text->data()));
  return number;
}

/// Reads what follows a unit: `*FACTOR`, then `+OFFSET` or `-OFFSET`, each only if it is there.
Scale scale_after_unit(std::string_view text) {
  Scale scale;
  if (!text.empty() && text[0] == '*') {
    std::string_view rest = text.substr(1);
    scale.factor = take_number(&rest);
    const bool ends_well = rest.empty() || rest[0] == '+' || rest[0] == '-';
    if (!std::isfinite(scale.factor) || scale.factor == 0 || !ends_well) {
      throw InputError(fmt::format("factor '{}': expected a number that is not zero",
                                   files::one_line(text.substr(1))));
    }
    text = rest;
  }
  if (!text.empty()) {
    std::string_view rest = text.substr(1);
    const double size = !rest.empty() && rest[0] == '-' ? std::numeric_limits<double>::quiet_NaN()
                                                        : take_number(&rest);
    if (!std::isfinite(size) || !rest.empty()) {
      throw InputError(fmt::format("offset '{}': expected a number", files::one_line(text)));
    }
    scale.offset = text[0] == '-' ? -size : size;
  }
  return scale;
}

}  // namespace

std::optional<Quantity> quantity_of(std::string_view column) {
  const auto begins = [column](std::string_view prefix) {
    const std::string_view rest = column.substr(std::min(prefix.size(), column.size()));
    return column.substr(0, prefix.size()) == prefix && !rest.empty() && rest[0] != '0' &&
           rest.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const auto is_one_of = [column](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), column) != names.end();
  };
  if (column == "t") {
    return Quantity::time;
  }
  if (begins("q_cmd_") || begins("q_meas_") || begins("q_link_")) {
    return Quantity::joint;
  }
  if (begins("tau_")) {
    return Quantity::drive;
  }
  if (is_one_of({"fx", "fy", "fz"})) {
    return Quantity::force;
  }
  if (is_one_of({"mx", "my", "mz"})) {
    return Quantity::torque;
  }
  if (is_one_of({"x", "y", "z"})) {
    return Quantity::length;
  }
  if (column == "temp_c") {
    return Quantity::temperature;
  }
  return column == "line" ? std::optional(Quantity::line) : std::nullopt;
}

Scale scale_of(const std::string& text, Quantity quantity) {
  const std::string unit = text.substr(0, text.find_first_of("*+-"));
  const Scale own = scale_after_unit(std::string_view(text).substr(unit.size()));
  if (unit == "%") {
    if (text.find('*') == std::string::npos) {
      throw InputError("unit '%': percent of what? Say what 100 % is: %*250");
    }
    return {own.factor / 100, own.offset};
  }
  const Scale scale = scale_of_unit(unit, quantity);
  return {own.factor * scale.factor, own.offset * scale.factor + scale.offset};
}

}  // namespace flexcomp::recording
