#pragma once

#include <limits>
#include <string>

#include "effects/machine_size.hpp"

namespace flexcomp::effects {

/// The bounds of a range that a fit may rest on: there the quantity is nothing, or its exact size
/// ceases to matter.
enum class Rest { nowhere, below, above, both };

/// Range of a parameter on a machine that can be; a range of changes where the parameter changes
/// the model.
struct Range {
  double lower = 0;
  double upper = 0;
  Rest rest = Rest::nowhere;
  const char* source = "";  ///< a data sheet, a standard, a paper or a physical argument
  /// Standard deviation of what models are off by; endless where nothing is known of it.
  double usual = std::numeric_limits<double>::infinity();
};

/// A parameter of a law at a place on a robot.
struct Subject {
  const model::Robot& robot;
  const MachineSize& size;
  int place;  ///< joint, from 1 on; 0 where the law acts on the whole machine
  const std::string& parameter;

  std::size_t index() const;
  const model::ChainJoint& joint() const { return robot.elastic.joints[index()]; }
  const model::JointDynamics& dynamics() const { return robot.dynamics[index()]; }
  double effort() const { return size.effort[index()]; }
  double velocity() const { return size.velocity[index()]; }
  double load() const { return size.load[index()]; }
  double largest_load() const;
};

/// A range for parameters of an effect.
struct ParameterRange {
  const char* form;        ///< the form of the effect that it is for; empty: all of them
  const char* parameters;  ///< names, each with a space before and behind it
  Range (*range)(const Subject&);
  const char* source;
};

/// A change of so much, up or down.
Range within(double size);
/// The same, mostly by no more than `usual`.
Range within(double size, double usual);
/// From nothing, where a fit may rest, up to `most`.
Range up_to(double most);
/// Changes of a number that the model knows and that lies between nothing and `most`.
Range change(double known, double most);

/// A quotient; endless where either number is not known.
double over(double value, double divisor);

/// Compliance with which a spring gives by `most` under a load, or the softest of any where that is
/// less.
double softest(double of_any, double most, double load);

constexpr double kSpringTurn = 0.1;  ///< rad, the most under the load that a spring bore
/// Error of an arm's geometry against its drawing, several times of what calibration found on
/// industrial arms (Nubiola and Bonev 2013; Ginani and Motta 2011): tenths of a millimetre and of a
/// milliradian up to some, on reaches of 1 to 3 m.
constexpr double kUsualShift = 2e-3;      ///< of the reach
constexpr double kUsualTilt = 5e-3;       ///< rad
constexpr double kShiftOfReach = 0.05;    ///< of the reach, the same
constexpr double kMostTurn = 0.1;         ///< rad/(N·m), of springs that are made soft on purpose
constexpr double kMostShift = 0.01;       ///< m/N, ten times as soft as rubber feet
constexpr double kGravity = 9.81;         ///< m/s²
constexpr double kLargestPayload = 2300;  ///< kg, of the strongest arm that is sold (data sheet)

}  // namespace flexcomp::effects
