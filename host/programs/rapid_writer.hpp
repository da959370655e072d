#pragma once

#include <string>

#include "programs/corrected_program.hpp"

namespace flexcomp::programs {

/// A RAPID module of a program: one in RAPID with its motions' targets replaced, in its own work
/// object where the module tells that; one of another format anew, with a work object of its own.
std::string rapid_text(const CorrectedProgram& program, const std::string& name);

}  // namespace flexcomp::programs
