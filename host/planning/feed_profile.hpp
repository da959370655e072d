#pragma once

#include "planning/inverse_kinematics.hpp"
#include "planning/program_path.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// How fast a program may be run.
struct FeedLimits {
  double feed = 0.05;  ///< m/s, where the program does not say
  /// rad/s, of the orientation, where the program does not say: that of ABB's v5 to v7000
  double turn = 500 * programs::kDegree;
  double rapid = 0.5;         ///< m/s, of rapids
  double acceleration = 2.0;  ///< m/s², along the way and across it
  double corner = 1e-4;  ///< m, by which a corner would be rounded at the speed it is passed at
  Angles joint_speed = Angles::Zero();  ///< rad/s; zero for one without a limit
};

/// Times of a program's points, s, from rest to rest: as fast as the program's feeds and the limits
/// let it be (forwards and backwards over the speeds at the points).
Eigen::VectorXd times_along(const programs::Program& program, const std::vector<PathPoint>& points,
                            const recording::Samples& q, const FeedLimits& limits);

}  // namespace flexcomp::planning
