#pragma once

#include <string>

#include "diagnosis/search/hypothesis.hpp"

namespace flexcomp::diagnosis {

using effects::MachineSize;
using effects::Range;
using effects::Rest;
using effects::size_of;

/// The size of the observations' machine, with the largest loads and force of the recordings.
MachineSize size_of(const Observations& observations);

/// Narrows a hypothesis' bounds to values that can be. It gets no start where none of its starts
/// can be.
void keep_plausible(const model::Robot& robot, const MachineSize& size, Hypothesis* hypothesis);

struct Fit;

/// Why one of a fit's hypotheses, as fitted, cannot be so: a number is outside of its range, or
/// rests on a bound that means nothing, or the machine with it could not be. Empty if it can.
///
/// A machine with other masses can be if no mass is negative, every centre of mass lies within the
/// body (then some inertia makes it one; Wensing, Kim and Slotine 2018), and, where the effect says
/// the inertia too, the joint-space inertia matrix is positive definite wherever the model's is
/// along the recordings.
std::string why_impossible(const Observations& observations, const Fit& fit, std::size_t index);

/// Could a hypothesis be so, as fitted, as a number that stands in for others? Numbers of a
/// regression need not. Unlike above, a number of a body may rest on its bound: torques tell masses
/// in combinations only, and one of several that fit the same lies there.
bool could_be(const Observations& observations, const Fit& fit, std::size_t index);

}  // namespace flexcomp::diagnosis
