#pragma once

#include <string>
#include <vector>

#include "control/arc_design.hpp"
#include "planning/circle.hpp"

namespace flexcomp::control {

/// A circle milled by an arm under dynamic control.
struct CircleRun {
  std::string control;
  double circularity = 0;             ///< m, least squares, of one turn
  double deviation = 0;               ///< m, largest distance of the TCP from the path
  double correction = 0;              ///< rad, largest of the compensator's
  std::vector<Eigen::Vector2d> path;  ///< m, in the plane, from the centre
};

/// The arm that mills, the arm that it is taken for, and the process.
struct CircleTrial {
  simulation::FlexibleArm<6> nominal;  ///< what controller and compensator know
  simulation::FlexibleArm<6> arm;      ///< the true one; its tool springs bend too
  ArcGains<double, 6> gains;
  planning::CirclePlan plan;
};

/// Mills the circle under the motors' servo (with feed-forward) and under adaptive robust control,
/// each without and with the deflection compensator.
///
/// The two do not do the same thing twice. A servo sees the motors alone, so the compensator
/// corrects for all springs; adaptive robust control sees the links and knows the measured wrench,
/// so the compensator gets a model without joint springs, whose tables have another model hash. Its
/// correction, 4 ms apart, goes through a critically damped filter of 5 Hz.
///
/// Throws InputError where the circle is out of reach or no table can be made.
std::vector<CircleRun> mill_circle(const CircleTrial& trial);

/// A gnuplot script of the paths, their distance from the circle fifty times as large.
std::string circle_script(const std::vector<CircleRun>& runs, double radius,
                          const std::string& title);

}  // namespace flexcomp::control
