#pragma once

#include <functional>
#include <optional>

#include "planning/inverse_kinematics.hpp"
#include "planning/program_path.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// A program's points as joint angles, on one branch of the inverse kinematics.
struct FollowedPath {
  Pose<double> frame;  ///< the work frame in the robot base frame
  double spin = 0;     ///< rad, of the tool about its own axis, the same all along
  recording::Samples q;
  double joint_margin = 0;    ///< rad, from the nearest joint limit
  double singular_value = 0;  ///< least one of the Jacobian, metres and radians alike
};

/// Follows a program with a six-axis robot.
///
/// Where `program.has_free_spin`, the tool's turn about its own axis is chosen, and in any case the
/// posture, so that the path stays away from joint limits and singularities: the smaller of the
/// distance from the limits (rad) and three times the least singular value is made largest, over up
/// to 200 points. Without a frame, one is looked for that holds the program in front of the robot,
/// axes along the base's: the nearest where that is 0.5 or more, else where it is largest. With
/// `near`, joint angles of the first point, the posture is the one nearest to them.
///
/// `progress` is told: points done, and of how many. Throws InputError with the program's line that
/// no posture gets past within the joint limits and without a jump.
FollowedPath follow(const RobotModel<double, 6>& model, const programs::Program& program,
                    const std::vector<PathPoint>& points, const std::optional<Pose<double>>& frame,
                    const std::optional<Angles>& near,
                    const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace flexcomp::planning
