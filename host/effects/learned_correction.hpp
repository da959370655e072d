#pragma once

#include "effects/learned.hpp"

namespace flexcomp::effects {

/// Distances (m) of the TCP, as the machine with all that was learnt of it is believed to go, from
/// where it should pass: the largest of a program.
struct LearnedCorrection {
  recording::Samples q_cmd;  ///< rad, corrected
  double before = 0;
  double after = 0;
};

/// Corrects a program for what the core cannot know: the effects that were learnt of the robot by a
/// diagnosis (play, hysteresis, ripple, lag, drift, lengths, …), history included.
///
/// `wanted`: n×3, m, where the TCP should pass (base frame); `program`: times (s), wrench on the
/// tool as its sensor reads it, temperatures, and the commands q_cmd to begin with, which the core
/// may have corrected already. What only the measurement showed (its clocks and its frame) and
/// vibrations are left aside. Of the steps the best counts: it is never farther off, as the machine
/// is believed to go, than without. Positions are corrected, orientations stay: repeated Newton
/// steps through the Jacobian of the bent robot, damped near singularities (Wampler 1986). Throws
/// InputError as `machine_of` does.
LearnedCorrection correct_for_learned(const model::Robot& robot,
                                      const recording::Recording& program,
                                      const recording::Samples& wanted);

}  // namespace flexcomp::effects
