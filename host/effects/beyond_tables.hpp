#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"

namespace flexcomp::effects {

/// The effects of a robot's list, by name, that a table lacks although they move the TCP: a table,
/// and the core with it, knows the keys of the robot's file only. Throws InputError as
/// `listed_effects` does.
std::vector<std::string> beyond_tables(const model::Robot& robot);

/// One line that says so of a robot; empty where a table has all that moves it.
std::string warning_beyond_tables(const model::Robot& robot);

}  // namespace flexcomp::effects
