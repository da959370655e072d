#pragma once

#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis {

/// Widens the findings' intervals by what these recordings cannot rule out beside them.
///
/// On a small path a longer link moves the tool as another TCP does. If both are there, the TCP
/// alone may account for all, with a wrong number. So each number of each other hypothesis is taken
/// to be off by its usual size, or by what changes a quarter of what all findings do, whichever is
/// less:
///
/// - One that would not show beside the findings adds what it would shift their numbers by.
/// - One for which evidence speaks, though too weak to be named, adds the shift by its estimate.
///
/// Each finding's numbers are as uncertain as the worst of these makes them.
void widen_by_confounders(const Inquiry& inquiry, Choice* choice);

}  // namespace flexcomp::diagnosis
