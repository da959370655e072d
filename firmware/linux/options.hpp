#pragma once

#include <optional>
#include <string>
#include <vector>

#include "linux/rsi_options.hpp"
#include "linux/sensor_options.hpp"
#include "node/node_settings.hpp"

namespace flexcomp {

/// An option that only the start reads.
struct FixedOption {
  std::string name;   ///< as in the configuration file
  std::string value;  ///< as text, the same for the same value
};

/// Options of flexcompd, from its command line and its configuration file.
struct Options {
  std::string can;  ///< interface, or empty
  bool fd = false;
  std::string lcm;  ///< address, or empty
  RsiOptions rsi;
  SensorOptions sensor;
  std::string key;              ///< file with the key for messages on CAN, or empty
  std::string table;            ///< file to start with, or empty
  std::string state_directory;  ///< where tables from the bus are kept, or empty
  std::string statistics;       ///< file for statistics, or empty
  std::string settings_out;     ///< file to write the settings to, for a microcontroller, or empty
  std::string user;             ///< to become once all is set up, or empty
  std::size_t table_capacity = std::size_t{4} << 20;  ///< bytes a slot
  int priority = 80;                                  ///< SCHED_FIFO; 0: ordinary scheduling
  NodeSettings settings;
  std::vector<FixedOption> fixed;  ///< all that only the start reads
};

/// Reads command line and configuration file. Returns nothing where the program is to end with
/// `exit_code` (help, version, or a complaint that has been made).
std::optional<Options> read_options(int argc, const char* const* argv, int* exit_code);

/// Names, in a sentence for a person, the options that `wanted` would change though only the start
/// reads them; empty if there are none: then the rest may take effect.
std::string refused_changes(const Options& running, const Options& wanted);

}  // namespace flexcomp
