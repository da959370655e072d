#pragma once

#include <string>

#include "programs/corrected_program.hpp"

namespace flexcomp::programs {

/// A tool path as CSV, as `read_cartesian_csv` takes it: with qw,qx,qy,qz, for the corrected
/// orientation; arcs as short lines.
std::string csv_text(const CorrectedProgram& program);

}  // namespace flexcomp::programs
