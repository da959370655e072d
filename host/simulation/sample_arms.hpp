#pragma once

#include "simulation/flexible_arm.hpp"

namespace flexcomp::simulation {

/// One link in the vertical plane, at zero level: inertia 4 kg·m², weight 80 N·m · cos q, spring
/// 1e4 N·m/rad, rotor 1 kg·m².
FlexibleArm<1> one_link_arm();

/// Two links in the vertical plane, as in the literature on flexible joints: 15 kg and 10 kg, 1 m
/// and 0.8 m, springs 2e4 and 1e4 N·m/rad; a payload, so far none, at its tip.
FlexibleArm<2> two_link_arm();

}  // namespace flexcomp::simulation
