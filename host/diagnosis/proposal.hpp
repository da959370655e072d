#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence.hpp"

namespace flexcomp::diagnosis {

/// A term that describes a residual without naming its cause.
struct ProposedTerm {
  std::string text;  ///< "angle of joint 3 in error by |load on joint 2|"
  std::string unit;  ///< of the coefficient
  double coefficient = 0;
  double deviation = 0;  ///< standard
  double share = 0;      ///< of the power that is left without it beyond the noise
};

/// A sparse sum of terms beside what is known.
struct Proposal {
  Fit fit;  ///< of what is known and the terms behind it
  std::vector<ProposedTerm> terms;
};

/// Proposes a form for what a fit of known effects leaves: at most three terms of a library (errors
/// of each joint's angle and torque by angles, speeds, loads, time and temperature, their sizes and
/// squares, a constant with each), chosen one by one by orthogonal matching pursuit (Pati,
/// Rezaiifar and Krishnaprasad 1993), each kept only if what was held out confirms it beside the
/// others. Terms that a known effect stands for are not in the library.
Proposal propose(const Observations& observations, const Fit& known);

}  // namespace flexcomp::diagnosis
