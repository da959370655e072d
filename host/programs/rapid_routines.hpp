#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "programs/scanner.hpp"

namespace flexcomp::programs {

/// A PROC, FUNC or TRAP of a module, or, without a name, what stands outside of all.
struct RapidRoutine {
  std::size_t begin = 0;        ///< byte of its header
  std::size_t line = 1;         ///< of its header
  std::size_t motion_line = 0;  ///< of its first motion; zero where it has none
  std::set<std::string> calls;  ///< first words of its statements
};

/// Routines by name in capitals.
using RapidRoutines = std::map<std::string, RapidRoutine>;

/// The name of the routine that a statement begins; empty for another statement.
std::string rapid_routine_begun(Scanner scanner);

RapidRoutines rapid_routines(std::string_view text);

/// Those that move the robot, by themselves or by what they call. What stands outside of all
/// counts where there is nothing else.
std::set<std::string> moving_routines(const RapidRoutines& routines);

/// MoveAbsJ, and the routines that it stands in or that call such.
std::set<std::string> joint_moving_routines(const RapidRoutines& routines);

/// Where a module that moves begins: `main` if it does, else the one that moves and that no other
/// calls; the first such where there are several. Empty where nothing moves, or outside of all.
std::string first_routine(const RapidRoutines& routines, const std::set<std::string>& moving);

}  // namespace flexcomp::programs
