#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads a KUKA program: .src, and the .dat of the same name beside it if there is one.
///
/// Motions are PTP, LIN, CIRC (with CA), their spline forms SPTP, SLIN and SCIRC, and LIN_REL, to
/// points in braces or by name. Feeds come from $VEL.CP, $VEL={CP …} and BAS(#VEL_CP or
/// #CP_PARAMS, …), the work frame from a $BASE in numbers. The TCP frame is the robot's; $TOOL is
/// noted.
///
/// Points in joint angles and points that no file tells, such as HOME, are left out, as everything
/// that does not move is; what is unknown is noted with its line. Throws InputError with file and
/// line for motions that cannot be told: in branches, loops and subprograms, splines of SPL,
/// unknown points of LIN and CIRC, a second $BASE.
Program read_krl(const std::filesystem::path& file);

/// The same of texts.
Program krl_program(const std::string& file, std::string src, const std::string& dat);

}  // namespace flexcomp::programs
