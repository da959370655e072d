#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"

namespace flexcomp::check {

/// A robot by itself: springs out of the usual range for what its drives bear (compliance.size), a
/// gravity that is none (gravity.size), a payload without weight (gravity.missing) or one that its
/// arm cannot carry (payload.size).
///
/// Usual: a joint gives 0.1 to 150 mrad under its largest torque. Heavy robots give 4 to 10 mrad
/// (Klimchik et al. 2017 with the makers' torques), harmonic drives of cobots 5 to 20, springs in
/// series more. A slip of units (mm, degrees, stiffness in place of compliance) is a factor of 57
/// or more.
Checks check_model(const model::Robot& robot);

}  // namespace flexcomp::check
