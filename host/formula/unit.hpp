#pragma once

#include <array>
#include <string>

namespace flexcomp::formula {

/// Exponents of metre, kilogram, second and kelvin. An angle is a plain number, as in the SI (BIPM,
/// "The International System of Units", 9th edition, table 4).
using Dimension = std::array<double, 4>;

constexpr Dimension kPlain = {0, 0, 0, 0};

Dimension operator+(const Dimension& a, const Dimension& b);
Dimension operator-(const Dimension& a, const Dimension& b);
Dimension operator*(double factor, const Dimension& dimension);
bool is_same(const Dimension& a, const Dimension& b);

/// Reads a unit: a product of m, kg, s, K, rad, N, J, W, Hz and 1 with powers, such as N·m·s/rad,
/// rad/(N·m)^2 or m/s². Prefixes are none, since numbers are in SI units. Throws FormulaError.
Dimension dimension_of(const std::string& unit);

/// A unit of the dimension, with newtons where that is shorter; "1" for a plain number.
std::string unit_text(const Dimension& dimension);

}  // namespace flexcomp::formula
