#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads a program in G-code: G0 to G3 (arcs by I, J, K or R; helices; P turns), G4, G17 to G19,
/// G20 and G21, G90 and G91, G90.1 and G91.1, G93 and G94, X, Y, Z, A, B, C, F, and the words that
/// move nothing (N, O, S, T, H, D, spindle, coolant, tool change, stops). RS274/NGC (NISTIR 6556).
///
/// X, Y and Z are of the tool's tip (as after G43.4). A, B and C turn the tool about the work
/// frame's x, then y, then z; where all are zero it points against z.
///
/// Tool lengths and one work offset (G54 to G59.3) are the robot's tool and the work frame. G28,
/// G30 and G53, which go to places of the machine, are noted and left out. X, Y and Z are not known
/// until they are told, and so are the axes that those three name, and X, Y and Z behind M6, until
/// they are told again: a G0 while one is unknown is no motion of the program, and is noted.
///
/// Throws InputError with file, line and word for every other word, since one that is left out
/// would be another program, and for a motion at a feed from an unknown place.
Program read_gcode(const std::filesystem::path& file);

/// The same of a text.
Program gcode_program(const std::string& file, std::string text);

}  // namespace flexcomp::programs
