#include "flexcomp/status.hpp"

namespace flexcomp {

const char* describe(Result result) {
  switch (result) {
    case Result::ok:
      return "ok";
    case Result::bad_argument:
      return "an argument is null, misaligned, unknown or out of its range";
    case Result::bad_model:
      return "a number of the robot model is not finite or out of its range";
    case Result::bad_config:
      return "a number of the configuration is not finite or out of its range";
    case Result::bad_path:
      return "the path has fewer than two distinct points or a point that is not finite";
    case Result::buffer_too_small:
      return "the buffer cannot hold a table within the tolerance";
    case Result::tolerance_not_met:
      return "the tolerance is finer than the arithmetic or the format can certify";
    case Result::chart_not_invariant:
      return "turning joint 1 or the last joint changes the compliance; use a path table";
    case Result::table_misaligned:
      return "the table does not start at a multiple of 4 bytes";
    case Result::table_truncated:
      return "the table is shorter than it says";
    case Result::table_not_a_table:
      return "not a flexcomp table";
    case Result::table_version:
      return "the table is of another format version";
    case Result::table_corrupt:
      return "the table is damaged";
    case Result::table_other_model:
      return "the table was made for another robot, tool or payload";
    case Result::gain_too_high:
      return "the gain is above the largest safe one of the table";
    case Result::not_ready:
      return "not ready: good inputs are needed first, or another state";
    case Result::no_table:
      return "no table is loaded";
  }
  return "unknown result";
}

}  // namespace flexcomp
