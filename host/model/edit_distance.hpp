#pragma once

#include <cstddef>
#include <string_view>

namespace flexcomp::model {

/// Letters to insert, drop or replace to make one word of the other (Levenshtein).
std::size_t edit_distance(std::string_view from, std::string_view to);

}  // namespace flexcomp::model
