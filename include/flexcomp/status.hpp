#pragma once

/// @file
/// Results of calls.

#include <cstdint>

namespace flexcomp {

/// Result of a call. The numbers are stable: they appear in logs and on the bus.
enum class Result : std::uint8_t {
  ok = 0,
  bad_argument = 1,         ///< null, misaligned, unknown, or a number that cannot be
  bad_model = 2,            ///< a number of the model is not finite or out of its range
  bad_config = 3,           ///< a number of the configuration is not finite or out of its range
  bad_path = 4,             ///< fewer than two distinct points, or a point that is not finite
  buffer_too_small = 5,     ///< the caller's buffer cannot hold a table within the tolerance
  tolerance_not_met = 6,    ///< the scalar type is too coarse for the tolerance
  chart_not_invariant = 7,  ///< turning joint 1 or 6 changes the compliance: use a path chart
  table_misaligned = 8,     ///< the table does not start at a multiple of 4 bytes
  table_truncated = 9,      ///< fewer bytes than the table says it has, or than a header
  table_not_a_table = 10,   ///< the magic number is another
  table_version = 11,       ///< made for another version of the format
  table_corrupt = 12,  ///< the CRC-32 or a field contradicts the content, or a number is not finite
  table_other_model = 13,  ///< made for another robot, tool or payload
  gain_too_high = 14,      ///< above the largest safe gain in the table
  not_ready = 15,  ///< too few good inputs in a row to arm, or not in the state for the call
  no_table = 16,   ///< there is no table yet
};

/// A few words for a person; never null.
const char* describe(Result result);

}  // namespace flexcomp
