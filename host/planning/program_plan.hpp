#pragma once

#include <functional>
#include <optional>

#include "planning/feed_profile.hpp"
#include "planning/program_follower.hpp"

namespace flexcomp::planning {

/// How a program becomes a path of joint angles.
struct ProgramPlan {
  PathSampling sampling;
  FeedLimits limits;
  std::optional<Pose<double>> frame;  ///< the work frame in the base frame; else the program's own
  std::optional<Angles> near;         ///< joint angles that the first point is to be near to
  /// Wrench on the tool where it cuts, N and N·m at the TCP: along the feed, to the left of it seen
  /// from the spindle, and up the spindle.
  Wrench<double> cutting = Wrench<double>::Zero();
};

struct PlannedProgram {
  recording::Recording recording;  ///< t, q_cmd, the wrench, and the program's line
  FollowedPath path;
};

/// A program as a recording. Where the TCP goes along the tool's own axis, only what the cutting
/// wrench has along that axis acts. Throws InputError as `follow` does, and for a program without
/// two points.
PlannedProgram plan_program(const RobotModel<double, 6>& model, const programs::Program& program,
                            const ProgramPlan& plan,
                            const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace flexcomp::planning
