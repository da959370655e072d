#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads an ABB program: a RAPID module with MoveJ, MoveL and MoveC to robot targets, in brackets,
/// by name, as elements of an array, by Offs and by RelTool, with numbers and constants; feeds by
/// name (v100), by speeddata, by \V, \T and VelSet; the work frame by wobjdata in the module (user
/// frame times object frame). Reading begins at `main`, or at the routine that moves and that no
/// other calls; routines of the module that it calls are followed.
///
/// MoveAbsJ and targets that the module does not tell are left out, as everything that does not
/// move is; the motion behind has no known start; what is unknown is noted with its line, and so
/// are what stands behind RETURN and the configuration. Throws InputError with file and line for
/// motions that cannot be told: in branches and loops, in routines that are not called once and
/// without arguments, behind GOTO or a RETURN in a branch, with instructions or options that are
/// not read, about unknown targets of MoveL and MoveC, in a second work object or with a second
/// tool, where the robot holds the work or a mechanical unit moves it, with external axes that
/// move, and displaced by PDispSet and the like.
Program read_rapid(const std::filesystem::path& file);

/// The same of a text.
Program rapid_program(const std::string& file, std::string text);

}  // namespace flexcomp::programs
