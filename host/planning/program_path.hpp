#pragma once

#include <vector>

#include "programs/program.hpp"

namespace flexcomp::planning {

/// How finely a program is followed.
struct PathSampling {
  double chord_error = 5e-6;   ///< m, of the way between two points off the program's
  double largest_step = 5e-3;  ///< m
  double largest_turn = 0.02;  ///< rad
};

/// A point of a program's way.
struct PathPoint {
  Pose<double> pose;                                         ///< TCP in the work frame
  Vector3<double> feed_direction = Vector3<double>::Zero();  ///< unit; zero where only turned
  std::size_t motion = 0;  ///< number of the motion that it belongs to
};

using programs::kTurningLever;

/// Points along a program: its first motion's end, and then every motion's points without its
/// start. Ends of motions are points, to the last bit; motions that go nowhere have none. A
/// straight motion that does not turn has its ends alone where `largest_step` lets it.
std::vector<PathPoint> sample(const programs::Program& program, const PathSampling& sampling);

/// How far it is from one point to the next, m; turning counts too.
double distance(const Pose<double>& from, const Pose<double>& to);

}  // namespace flexcomp::planning
