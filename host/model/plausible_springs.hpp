#pragma once

#include "model/chain.hpp"

namespace flexcomp::model {

/// The softest springs that a robot can be. What lies beyond is a slip: 0.5 for 0.5e-6, or a
/// stiffness in place of a compliance.
///
/// Joints of heavy robots give 2e-7 to 1e-5 rad/(N·m) (Klimchik et al. 2017), harmonic drives of
/// cobots 1e-5 to 1e-3 (their makers' catalogues: 1e3 to 1e5 N·m/rad), desktop arms up to 1e-2, and
/// joints that are made soft on purpose, with springs in series, some 5e-2.
constexpr double kMostTurn = 0.1;  ///< rad/(N·m)
/// Foundations give 1e-10 to 1e-7 m/N, spindles and their holders up to 1e-6, rubber feet 1e-4.
constexpr double kMostShift = 0.01;  ///< m/N
/// A spring's cubic part, which may not be the larger one at a newton metre, or newton, either.
constexpr double kMostCubicTurn = 0.1;    ///< rad/(N·m)³
constexpr double kMostCubicShift = 0.01;  ///< m/N³

/// The softest spring that a joint can have, linear and cubic: by whether it turns or slides.
double softest_of(const ChainJoint& joint);
double softest_cubic_of(const ChainJoint& joint);

/// Is no spring of the chain softer than that?
bool has_plausible_springs(const Chain& chain);

}  // namespace flexcomp::model
