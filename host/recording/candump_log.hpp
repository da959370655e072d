#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "messages/can_frame.hpp"

namespace flexcomp::recording {

/// A frame as candump -L has logged it.
struct LoggedFrame {
  std::int64_t time = 0;  ///< ns since the epoch
  std::string interface;
  CanFrame frame;
};

/// Reads a log of candump -L (or -l): "(seconds) interface id#data", "id##flags data" for FD.
/// Remote and error frames and 29-bit identifiers, which flexcomp does not use, are left out.
///
/// Throws InputError with file and line for anything else, and for more than 64 interfaces.
std::vector<LoggedFrame> read_candump_log(const std::filesystem::path& path);

/// Writes such a log, whole or not at all. Throws InputError where the file cannot be written.
void write_candump_log(const std::filesystem::path& path, const std::vector<LoggedFrame>& frames);

}  // namespace flexcomp::recording
