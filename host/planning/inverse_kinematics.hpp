#pragma once

#include <optional>
#include <vector>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

using Angles = JointVector<double, 6>;

/// Joint angles that put the TCP at `target` (base frame) to 1e-9 m and rad, found near `seed` and
/// within the joint limits; nothing if there are none. By Newton's method, and where that goes
/// elsewhere by KDL's Levenberg–Marquardt solver.
std::optional<Angles> solve_near(const RobotModel<double, 6>& model, const Pose<double>& target,
                                 const Angles& seed);

/// The different joint angles within the limits that put the TCP at `target` to 1e-9 m and rad,
/// those farthest from the limits first; whole turns are not told apart. In closed form where the
/// robot has one (see closed_form.hpp), and then all there are; from there by Newton's method where
/// it nearly has one; else, or where that gives none, those that a search from many starts finds.
std::vector<Angles> solve_all(const RobotModel<double, 6>& model, const Pose<double>& target);

/// Solutions of any robot, by the search alone: slower by far, and it may miss some.
std::vector<Angles> search_all(const RobotModel<double, 6>& model, const Pose<double>& target);

}  // namespace flexcomp::planning
