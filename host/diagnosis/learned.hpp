#pragma once

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// The machine that a robot's file describes, with the effects that were learnt of it, and with
/// play by its key `backlash` where none was learnt. Throws InputError for an effect, form or
/// parameter that is unknown, or that these scenes cannot show (a drift by temperature without
/// temperatures).
Machine machine_of(const model::Robot& robot, const std::vector<Scene>& scenes);

/// The robot with what a fit found: by the keys of its file where there are any, else as effects.
model::Robot updated_robot(const Observations& observations, const Fit& fit);

}  // namespace flexcomp::diagnosis
