#pragma once

#include <optional>
#include <vector>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

/// Joint angles of an industrial robot, from formulas.
struct ClosedForm {
  /// rad, to whole turns, joint limits not looked at; at most eight.
  std::vector<JointVector<double, 6>> solutions;
  /// Are they solutions, and all there are? Else the robot is of the kind only nearly, and they are
  /// places for Newton's method to begin at, which may miss some.
  bool is_exact = true;
};

/// All joint angles that put the TCP of an industrial robot at `target` (base frame): two ways
/// round joint 1, two elbows, two wrists. Of a robot of another kind, nothing.
///
/// The axes of joints 2 and 3 are parallel and at right angles to that of joint 1, wherever they
/// are; joint 5 turns at right angles to joints 4 and 6; and one of these holds:
/// - the last three axes meet in a point (Pieper 1968; Brandstötter et al. 2014), or
/// - joint 4 is parallel to joints 2 and 3, and the last two axes meet (arms such as the UR).
///
/// Axes that meet or are parallel to 10⁻⁵ (rad, and of the robot's reach) count as exact, as model
/// files round π/2 to six digits; to 10⁻³ as nearly exact, as those of a calibrated robot are.
std::optional<ClosedForm> solve_closed_form(const RobotModel<double, 6>& model,
                                            const Pose<double>& target);

}  // namespace flexcomp::planning
