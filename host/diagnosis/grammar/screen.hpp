#pragma once

#include "diagnosis/grammar/driver.hpp"
#include "diagnosis/grammar/normal.hpp"

namespace flexcomp::diagnosis::grammar {

/// Rows and drivers of the observations: the material of all laws, whatever is fitted.
struct Material {
  explicit Material(const Observations& all)
      : observations(all), rows(all), drivers(drivers_of(all, rows)) {}

  const Observations& observations;
  Rows rows;
  std::vector<Driver> drivers;
};

/// A quantity that multiplies a law: the direction of a joint's motion where friction changes, the
/// load where a gain does.
struct Factor {
  std::string text;        ///< of a formula, such as sign(v5); empty where it is one
  std::string signal;      ///< that it is of, such as v5
  Eigen::VectorXd course;  ///< rows; empty where it is one
};

/// A driver and a factor that a law at a seat may follow, whatever its shape.
struct Lead {
  const Seat* seat;
  const Driver* driver;
  Factor factor;
  double gain;  ///< in squares, by what is told of it here
  double wave;  ///< 2π over the period along the driver with which a wave does most
  /// Is it a wave whose size follows another driver, and no other shape?
  bool swells = false;

  /// Is the factor of the driver itself?
  bool is_of_itself() const { return factor.signal == driver->name; }
};

/// The leads for what a fit leaves, the best first. A lead's gain is the largest fall of the
/// squares by its conditional mean (piecewise linear over the driver), a wave over it, a shape with
/// a memory or, in time, a step. Leads that gain much less than the best are left out. Behind them
/// stand waves over a joint's angle at that joint that gain more than any because their size
/// follows another driver. `looked_at` is raised by the number of leads that were looked at.
std::vector<Lead> screen(const Material& material, const std::vector<Seat>& seats,
                         std::size_t* looked_at);

}  // namespace flexcomp::diagnosis::grammar
