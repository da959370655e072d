#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// The format of a program by its file's ending, capital or not: .src is KRL, .mod, .modx and .prg
/// are RAPID, .csv is CSV, and .nc, .ngc, .gcode, .gc, .tap, .cnc, .iso and .mpf are G-code. Throws
/// InputError for another.
Format format_of(const std::filesystem::path& file);

/// Reads a program in the format of its ending; throws InputError as the format's reader does, and
/// for a program without motions.
Program read_program(const std::filesystem::path& file);

}  // namespace flexcomp::programs
