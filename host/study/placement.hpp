#pragma once

#include <functional>

#include "flexcomp/model.hpp"
#include "recording/recording.hpp"

namespace flexcomp::study {

/// How a job is moved as a whole, and how the tool is turned about its own axis.
struct Placement {
  Vector3<double> shift = Vector3<double>::Zero();  ///< m, base frame
  double turn = 0;                                  ///< rad, about a vertical axis in its middle
  double spin = 0;                                  ///< rad, of the TCP about its z axis
};

/// Where to look for a better place, and what is to be kept.
struct PlacementRequest {
  Vector3<double> most_shift{0.5, 0.5, 0.3};  ///< m, either way
  double most_turn = 0;                       ///< rad, either way
  double most_spin = M_PI;                    ///< rad, either way
  /// Least singular value of the Jacobian (metres and radians alike) that is far enough from a
  /// singularity.
  double least_singular_value = 0.05;
  double joint_margin = 0.05;  ///< rad, from the joint limits
  /// Points of the path that the search looks at; doubled where the place cannot be followed.
  int points = 24;
  int evaluations = 2000;
};

/// A job in its new place, and the error of the uncorrected robot along it.
struct PlacedJob {
  Placement placement;
  recording::Recording path;  ///< t, q_cmd and the wrench, in its new place
  double largest = 0;         ///< m, displacement of the TCP under the wrench
  double mean_square = 0;     ///< m, its root mean square
};

/// The displacement along a job as it is.
PlacedJob as_placed(const RobotModel<double, 6>& model, const recording::Recording& job);

/// The place where the largest displacement of the TCP along the job is least: a global search
/// (DIRECT, Jones et al. 1993), then a local one (Sbplx, Rowan 1990), both of NLopt. The job needs
/// q_cmd and the wrench, which turns with it. `progress` is told: evaluations done.
///
/// Throws InputError for a job that lacks them, or that no place looked at can be reached in.
PlacedJob best_placement(const RobotModel<double, 6>& model, const recording::Recording& job,
                         const PlacementRequest& request, const std::function<void(int)>& progress);

}  // namespace flexcomp::study
