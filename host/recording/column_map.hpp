#pragma once

#include <string>
#include <vector>

#include "recording/foreign_table.hpp"
#include "recording/recording.hpp"

namespace flexcomp::recording {

/// A recording from a table that others wrote, by rules `COLUMN=NAME` or `COLUMN=NAME:UNIT`. COLUMN
/// is one of a recording, NAME what it is called in the table, UNIT as in foreign_units.hpp.
///
/// A `*` on both sides stands for the joint's number: the names count from 1, or from 0 where the
/// table has such a name; a joint's column with a rule of its own follows that. Times count from
/// the first row, so that those since an epoch keep their digits; several rules for `t` (seconds
/// and nanoseconds) are added.
///
/// Throws InputError with the rule for one that cannot be read, a name that the table does not have
/// or has twice, a column with two rules; and as `numbers` and `recording_of` do.
struct Mapped {
  Recording recording;
  std::vector<std::string> left_out;  ///< the table's columns that no rule names
};
Mapped map_columns(const ForeignTable& table, const std::vector<std::string>& rules);

}  // namespace flexcomp::recording
