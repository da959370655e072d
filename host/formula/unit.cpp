#include "formula/unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/one_line.hpp"
#include "formula/formula.hpp"

namespace flexcomp::formula {
namespace {

constexpr double kMostPower = 100;

struct NamedUnit {
  const char* name;
  Dimension dimension;
};

constexpr std::array<NamedUnit, 9> kUnits = {{{"m", {1, 0, 0, 0}},
                                              {"kg", {0, 1, 0, 0}},
                                              {"s", {0, 0, 1, 0}},
                                              {"K", {0, 0, 0, 1}},
                                              {"rad", {0, 0, 0, 0}},
                                              {"N", {1, 1, -2, 0}},
                                              {"J", {2, 1, -2, 0}},
                                              {"W", {2, 1, -3, 0}},
                                              {"Hz", {0, 0, -1, 0}}}};

void replace_all(const std::string& what, const std::string& by, std::string* text) {
  for (std::size_t at = text->find(what); at != std::string::npos; at = text->find(what, at)) {
    text->replace(at, what.size(), by);
    at += by.size();
  }
}

Dimension named(const std::string& name) {
  for (const NamedUnit& unit : kUnits) {
    if (name == unit.name) {
      return unit.dimension;
    }
  }
  throw FormulaError(
      1, fmt::format(
             "'{}' is no SI unit; expected a product of m kg s K rad N J W Hz 1, such as N·m·s/rad",
             files::one_line(name)));
}

/// Dimension of one operation of a unit, by those of its operands.
Dimension combined(const Formula& unit, std::size_t at, const std::vector<Dimension>& before) {
  const Node& node = unit.nodes()[at];
  const auto [a, b] = node.operand;
  double exponent = 0;
  switch (node.operation) {
    case Operation::name:
      return named(unit.names()[node.index]);
    case Operation::multiply:
      return before[a] + before[b];
    case Operation::divide:
      return before[a] - before[b];
    case Operation::power:
      if (is_constant(unit, b, &exponent)) {
        return exponent * before[a];
      }
      break;
    case Operation::number:
    case Operation::negate:
      return kPlain;
    default:
      break;
  }
  throw FormulaError(1, "expected units multiplied and divided, such as N·m·s/rad");
}

/// "m^2*s", of one sign of the exponents.
std::string product(const std::vector<std::pair<const char*, double>>& factors, double sign) {
  std::string text;
  for (const auto& [name, exponent] : factors) {
    const double power = sign * exponent;
    if (power > 0) {
      text += fmt::format("{}{}{}", text.empty() ? "" : "·", name,
                          power == 1 ? "" : fmt::format("^{}", power));
    }
  }
  return text;
}

}  // namespace

Dimension operator+(const Dimension& a, const Dimension& b) {
  Dimension sum = a;
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(), std::plus<>());
  return sum;
}

Dimension operator-(const Dimension& a, const Dimension& b) { return a + -1 * b; }

Dimension operator*(double factor, const Dimension& dimension) {
  Dimension scaled = dimension;
  std::transform(scaled.begin(), scaled.end(), scaled.begin(),
                 [factor](double exponent) { return factor * exponent; });
  return scaled;
}

bool is_same(const Dimension& a, const Dimension& b) {
  constexpr double kTolerance = 1e-9;
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double x, double y) { return std::abs(x - y) < kTolerance; });
}

Dimension dimension_of(const std::string& unit) {
  std::string text = unit;
  replace_all("·", "*", &text);
  replace_all("²", "^2", &text);
  replace_all("³", "^3", &text);
  const Formula formula(text);
  std::vector<Dimension> all;
  for (std::size_t i = 0; i < formula.nodes().size(); ++i) {
    all.push_back(combined(formula, i, all));
    const Dimension& last = all.back();
    const bool is_small = std::all_of(
        last.begin(), last.end(), [](double exponent) { return std::abs(exponent) < kMostPower; });
    if (!is_small) {
      throw FormulaError(1, "expected powers that are small numbers");
    }
  }
  return all.back();
}

std::string unit_text(const Dimension& dimension) {
  const auto [m, kg, s, k] = dimension;
  std::vector<std::pair<const char*, double>> factors = {{"kg", kg}, {"m", m}, {"s", s}, {"K", k}};
  const bool is_shorter_in_newtons =
      std::abs(m - kg) + std::abs(s + 2 * kg) < std::abs(m) + std::abs(s);
  if (is_shorter_in_newtons) {
    factors = {{"N", kg}, {"m", m - kg}, {"s", s + 2 * kg}, {"K", k}};
  }
  const std::string above = product(factors, 1);
  const std::string below = product(factors, -1);
  const bool is_several = below.find("·") != std::string::npos;
  return (above.empty() ? "1" : above) +
         (below.empty() ? "" : (is_several ? "/(" + below + ")" : "/" + below));
}

}  // namespace flexcomp::formula
