#pragma once

#include <vector>

#include "formula/formula.hpp"

namespace flexcomp::formula {

/// The most of the candidates (indices of names) that together act in proportion: the formula is a
/// sum of terms that each have one of them as a factor. Where several sets are as large, the one
/// whose names come first. None where there is no such set, or more than 12 candidates.
std::vector<std::size_t> in_proportion(const Formula& formula,
                                       const std::vector<std::size_t>& candidates);

}  // namespace flexcomp::formula
