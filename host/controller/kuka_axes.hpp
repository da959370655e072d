#pragma once

#include <optional>
#include <string>

#include "flexcomp/model.hpp"
#include "rsi/axes.hpp"

namespace flexcomp::controller {

/// How a KUKA counts its axes against the joints of a URDF, from the geometry alone.
///
/// KUKA's convention is a matter of posture (AxisConvention): A2 is zero where the arm lies along
/// x, A3 where the forearm goes on in line with it, A5 where the hand goes on in line with the
/// forearm; A1 turns about -z, A2, A3, A5 about y, A4 and A6 about -x of the stretched arm. So the
/// signs come from the joints' axes at the URDF's zero, and the zeros of A2, A3 and A5 from where
/// arm, forearm and hand point there. Those of A1, A4 and A6 are taken to be zero: nothing that the
/// URDF holds for certain shows them.
///
/// Nothing for a robot that is not built so: two axes that are not level at the URDF's zero, or no
/// wrist in line with the forearm.
std::optional<AxisConvention> kuka_axes(const RobotModel<double, 6>& model);

/// Six numbers as a list, "1, 1, -1, 1, 1, 1".
std::string list_of(const std::array<double, 6>& numbers);

}  // namespace flexcomp::controller
