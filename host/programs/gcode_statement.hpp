#pragma once

#include <string>
#include <string_view>

namespace flexcomp::programs {

/// What a line of G-code that moves says beside its motion.
struct GcodeStatement {
  std::string prefix;         ///< block delete and the line's number, as they stand
  bool is_skippable = false;  ///< by block delete
  std::string rest;           ///< other words and comments
  std::string stops;          ///< of those M0, M1, M2, M30 and M60, which act behind the motion
};

/// Which words are left out with the motion's own.
struct GcodeOmission {
  bool is_arc = false;   ///< P too, which is of the arc
  bool has_feed = true;  ///< F, G93 and G94 too
};

/// Takes a line apart, leaving out the words of its axes, its kind and their modes. `splits_stops`:
/// stops are no part of the rest.
GcodeStatement gcode_statement(std::string_view line, const GcodeOmission& omission,
                               bool splits_stops);

}  // namespace flexcomp::programs
