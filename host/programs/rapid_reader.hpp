#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads an ABB program: a RAPID module with MoveJ, MoveL and MoveC to robot targets, in brackets
/// or by name, by Offs and by RelTool (without turning); feeds by name (v100), by speeddata and by
/// \V; the work frame by wobjdata in the module (user frame times object frame).
///
/// MoveAbsJ and targets that the module does not tell are left out, as everything that does not
/// move is; what is unknown is noted with its line. Throws InputError with file and line for
/// motions that cannot be told: in branches and loops, in more than one routine, with unknown
/// instructions, about unknown targets of MoveL and MoveC, and for a second work object.
Program read_rapid(const std::filesystem::path& file);

/// The same of a text.
Program rapid_program(const std::string& file, std::string text);

}  // namespace flexcomp::programs
