#pragma once

#include <string>

#include "programs/corrected_program.hpp"

namespace flexcomp::programs {

/// G-code of a program: one in G-code with the axes' words of its lines replaced and all its other
/// words kept, absolute (G90) and in the units that it has there; one of another format anew.
///
/// Lines that do not move stay as they are and mean what they meant: where they have axes in G91, a
/// line says so before them. Arcs are short lines. A, B and C, which turn the tool's axis alone,
/// stand where the source tilts the tool; else those of them that it has.
std::string gcode_text(const CorrectedProgram& program);

}  // namespace flexcomp::programs
