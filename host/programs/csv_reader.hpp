#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads a tool path as CSV: `x,y,z` (m, work frame), and of these what there is:
///
/// | columns | |
/// |---|---|
/// | `i,j,k` | direction from the tool's tip towards the spindle, any length: as APT's cutter
/// location | | `qw,qx,qy,qz` | orientation of the TCP frame, any length; z points into the work |
/// | `feed` | m/s; an empty cell is the feed before |
/// | `rapid` | 1 for a rapid, else 0 |
///
/// Without a direction the tool points against z. Rows are joined by straight lines. Throws
/// InputError with file, line and column for anything else.
Program read_cartesian_csv(const std::filesystem::path& file);

}  // namespace flexcomp::programs
