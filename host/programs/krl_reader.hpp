#pragma once

#include <filesystem>

#include "programs/program.hpp"

namespace flexcomp::programs {

/// Reads a KUKA program: .src, and the .dat of the same name beside it if there is one.
///
/// Motions are PTP, LIN, CIRC (with CA), their spline forms SPTP, SLIN and SCIRC, and LIN_REL, to
/// points in braces or by name, or to products of such (P1:P2). Feeds come from $VEL.CP, $VEL={CP
/// …}, BAS(#VEL_CP or #CP_PARAMS, …) and $OV_PRO, the work frame from a $BASE in numbers or a
/// BASE_DATA that the files tell, by $BASE=BASE_DATA[2], BAS(#BASE, 2) or the FDAT of an inline
/// form. A spline motion may set its own feed, base and tool (WITH). The TCP frame is the robot's;
/// $TOOL and the posture of S and T are noted.
///
/// Points in joint angles and points that no file tells, such as HOME, are left out, as everything
/// that does not move is; what is unknown is noted with its line, and so is what stands behind
/// RETURN. Throws InputError with file and line for motions that cannot be told: in branches, loops
/// and subprograms, behind GOTO or a RETURN in a branch, splines of SPL, unknown points of LIN and
/// CIRC, a second base or tool, external axes that move, ways other than from point to point with
/// $ORI_TYPE #VAR and $IPO_MODE #BASE, and for whatever else stands in a motion and is not read.
Program read_krl(const std::filesystem::path& file);

/// The same of texts.
Program krl_program(const std::string& file, std::string src, const std::string& dat);

}  // namespace flexcomp::programs
