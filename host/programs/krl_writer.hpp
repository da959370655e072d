#pragma once

#include <string>

#include "programs/corrected_program.hpp"

namespace flexcomp::programs {

/// A KRL module (.src) of a program: one in KRL with its motions' points replaced and a $BASE
/// before the first of them; one of another format anew, `name` as its name.
std::string krl_text(const CorrectedProgram& program, const std::string& name);

}  // namespace flexcomp::programs
