#pragma once

#include <array>
#include <cstddef>

namespace flexcomp::formula {

/// Units that a function asks for, and those that it gives.
enum class FunctionUnits {
  of_angle,   ///< a plain number or an angle gives a plain number
  of_number,  ///< the same, for functions that are no trigonometric ones
  root,       ///< the root of any unit
  same,       ///< arguments and value have one unit
  sign,       ///< any unit gives a plain number
  lag,        ///< any unit and a time give the first
};

/// A function that formulas may use.
struct Function {
  const char* name;
  std::size_t arguments;  ///< 1 or 2
  FunctionUnits units;
  /// Its value by its arguments; null for one that remembers.
  double (*value)(double, double);
};

enum FunctionIndex : std::size_t { kLag, kPlay };

/// All functions; the first two remember. `lag(x, T)` follows x late by a first-order lag, T y' + y
/// = x. `play(x, gap)` follows x with a gap (Visintin 1994, "Differential models of hysteresis").
/// `step(x)` is 1 above zero and else 0, `sign(0)` is 0, `log` is natural.
extern const std::array<Function, 17> kFunctions;

}  // namespace flexcomp::formula
