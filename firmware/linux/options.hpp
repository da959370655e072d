#pragma once

#include <optional>
#include <string>

#include "node/node.hpp"

namespace flexcomp {

/// What makes a tick.
enum class Trigger {
  setpoint,  ///< a setpoint, at most one a period; without one, the end of the period
  clock,     ///< the period alone
  lockstep,  ///< every setpoint, however fast they come; time is counted in periods
};

/// What flexcompd is told on its command line and in its configuration file.
struct Options {
  std::string can;  ///< interface, or empty
  bool fd = false;
  std::string lcm;  ///< address, or empty
  Trigger trigger = Trigger::setpoint;
  std::string table;            ///< file to start with, or empty
  std::string state_directory;  ///< where tables from the bus are kept, or empty
  std::string statistics;       ///< file for statistics, or empty
  std::string user;             ///< to become once all is set up, or empty
  std::uint32_t tolerated_losses = 3;
  std::size_t table_capacity = std::size_t{4} << 20;  ///< bytes a slot
  int priority = 80;                                  ///< SCHED_FIFO; 0: ordinary scheduling
  NodeConfig node;
};

/// Reads command line and configuration file. Returns nothing where the program is to end with
/// `exit_code` (help, version, or a complaint that has been made).
std::optional<Options> read_options(int argc, const char* const* argv, int* exit_code);

}  // namespace flexcomp
