#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formula/formula.hpp"
#include "formula/unit.hpp"

namespace flexcomp::formula {

/// Checks that a formula makes sense in units: both sides of a sum have one unit, arguments of
/// sine, exponential and their like are angles or plain numbers, powers of a unit are numbers, and
/// the result has the unit `wanted`.
///
/// `known`: for each of the formula's names its dimension, or nothing where the formula decides.
/// Returns the dimension of every name; nothing for one that the formula leaves open. Zero written
/// as a number has any unit. `what`: the result in words, for the message. Throws FormulaError.
std::vector<std::optional<Dimension>> check_dimensions(
    const Formula& formula, const std::vector<std::optional<Dimension>>& known,
    const Dimension& wanted, const std::string& what);

}  // namespace flexcomp::formula
