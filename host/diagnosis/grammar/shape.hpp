#pragma once

#include <string>
#include <vector>

#include "diagnosis/grammar/driver.hpp"

namespace flexcomp::diagnosis::grammar {

/// How a shape's own parameter is sought, relative to what drives it.
enum class Sought {
  scale,      ///< a size of the driver, at which a law saturates or falls off
  threshold,  ///< a value of the driver, at which something begins
  width,      ///< an extent along the driver
  wave,       ///< angle of a wave over the driver: periods a turn, or 2π times a frequency
  constant,   ///< a time (s)
};

struct ShapeParameter {
  const char* name;
  Sought sought;
};

/// What a driver does to a law's value: a sum of terms, each with an amplitude.
struct Shape {
  const char* name;
  std::vector<std::string> terms;  ///< formulas of the driver, written $, and of the parameters
  std::vector<ShapeParameter> parameters;
  /// Of drivers of which kinds; all where it is empty.
  std::vector<effects::SignalKind> kinds;

  bool fits(const Seat& seat, const Driver& driver) const;
  /// Is it one of a driver of this kind?
  bool suits(const Driver& driver) const;
  /// Does its value depend on what was before?
  bool remembers() const;
};

/// All shapes, the simplest first.
const std::vector<Shape>& shapes();

/// What a second driver may do to a law: each of its terms is multiplied with each of these.
const std::vector<Shape>& modulations();

/// A shape's terms, written for a driver.
std::vector<std::string> terms_of(const Shape& shape, const Driver& driver);

/// Its terms along all rows, a column each, by the values of its parameters.
Eigen::MatrixXd courses_of(const Shape& shape, const Driver& driver, const Rows& rows,
                           const Observations& observations, const Values& parameters);

/// Where the parameters are sought along a driver, and values to begin with (every combination);
/// `wave` is where a wave is begun with.
std::vector<Bounds> bounds_of(const Shape& shape, const Driver& driver,
                              const Observations& observations);
std::vector<Values> starts_of(const Shape& shape, const Driver& driver,
                              const Observations& observations, double wave);

}  // namespace flexcomp::diagnosis::grammar
