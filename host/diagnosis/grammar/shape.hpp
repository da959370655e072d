#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/grammar/driver.hpp"

namespace flexcomp::diagnosis::grammar {

/// How a parameter of a shape is sought, relative to the driver.
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

/// Physics of a shape that fits only some drivers of its kinds.
enum class ShapeTrait {
  none,
  shift,        ///< over time: something moves once; only a sensor sees that
  tone,         ///< over time: something sounds on; only a sensor sees that
  heating,      ///< squares a torque: not for a driver that is a power already
  whole_waves,  ///< repeats every turn of a joint: not for a joint that slides
};

/// A sum of terms of a driver, each with an amplitude: the course of a law's value.
struct Shape {
  const char* name;
  std::vector<std::string> terms;  ///< formulas of the driver, written $, and of the parameters
  std::vector<ShapeParameter> parameters;
  std::vector<effects::SignalKind> kinds;  ///< of the drivers; empty: any
  ShapeTrait trait = ShapeTrait::none;

  /// May a law at this seat follow this driver so?
  bool fits(const Seat& seat, const Driver& driver) const;
  /// Is the driver of one of the shape's kinds?
  bool suits(const Driver& driver) const;
  /// Does its value depend on what was before?
  bool remembers() const;
  /// Does it follow late, so that it depends for a while on what was before the first row?
  bool lags() const;
};

/// All shapes, the simplest first.
const std::vector<Shape>& shapes();

/// The first of them that has this name. One must.
const Shape& shape_named(std::string_view name);

/// Shapes of a second driver: each term of a law may be multiplied with each term of one of them.
const std::vector<Shape>& modulations();

/// A shape's terms, written for a driver.
std::vector<std::string> terms_of(const Shape& shape, const Driver& driver);

/// A shape's terms along all rows, a column each, by the values of its parameters.
Eigen::MatrixXd courses_of(const Shape& shape, const Driver& driver, const Rows& rows,
                           const Observations& observations, const Values& parameters);

/// How far the input of what lags ranges.
double span_of_input(const Shape& shape, const Driver& driver);

/// Bounds of a shape's parameters along a driver.
std::vector<Bounds> bounds_of(const Shape& shape, const Driver& driver,
                              const Observations& observations);
/// Values to begin a shape's parameters with, in every combination; `wave`: that of a wave.
std::vector<Values> starts_of(const Shape& shape, const Driver& driver,
                              const Observations& observations, double wave);

}  // namespace flexcomp::diagnosis::grammar
