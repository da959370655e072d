#pragma once

#include "diagnosis/grammar/composed.hpp"

namespace flexcomp::diagnosis::grammar {

/// A composed law as a hypothesis like any other, with its formula and its values.
Chosen chosen_of(const Observations& observations, const Composed& composed);

}  // namespace flexcomp::diagnosis::grammar
