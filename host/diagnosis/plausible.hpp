#pragma once

#include <array>
#include <string>

#include "diagnosis/search/hypothesis.hpp"

namespace flexcomp::diagnosis {

/// How large and strong a machine is: plausible ranges are in proportion to it. Infinite where
/// neither the model nor the recordings tell.
struct MachineSize {
  double reach = 0;          ///< m, of the stretched arm with its tool
  double payload = 0;        ///< kg, the most that an arm of these masses can carry
  double weight = 0;         ///< N, of the links that move; zero where the model has no masses
  double weight_torque = 0;  ///< N·m, of that weight on the stretched arm
  double force = 0;          ///< N, the largest on the tool
  std::array<double, 6> effort{};    ///< N·m, the largest torque of each joint's drive
  std::array<double, 6> velocity{};  ///< rad/s, the largest speed
  std::array<double, 6> load{};      ///< N·m, the largest that each joint's spring bore
};

/// Of a robot as its model describes it, without loads and force.
MachineSize size_of(const model::Robot& robot);

/// With the largest loads and force of the recordings.
MachineSize size_of(const Observations& observations);

/// The bounds of a range that a fit may rest on: there the quantity is nothing, or its exact size
/// ceases to matter.
enum class Rest { nowhere, below, above, both };

/// What a parameter can be on a machine that can be; of the change, where it changes the model.
struct Range {
  double lower = 0;
  double upper = 0;
  Rest rest = Rest::nowhere;
  const char* source = "";  ///< a data sheet, a standard, a paper or a physical argument
};

/// Range of a hypothesis' parameter on a robot of some size. Where the table holds none the range
/// is endless and its source empty.
Range plausible_range(const model::Robot& robot, const MachineSize& size,
                      const Hypothesis& hypothesis, const std::string& parameter);

/// Narrows a hypothesis' bounds to what can be. Where none of what would be tried can be, it gets
/// no start.
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

}  // namespace flexcomp::diagnosis
