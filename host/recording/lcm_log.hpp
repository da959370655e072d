#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flexcomp::recording {

/// An event as lcm-logger has logged it.
struct LoggedEvent {
  std::int64_t time = 0;  ///< ns since the epoch; µs in the file
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Reads an LCM event log (LCM, "The LCM Log File Format"). Throws InputError with file and byte
/// where it is damaged or ends within an event.
std::vector<LoggedEvent> read_lcm_log(const std::filesystem::path& path);

/// Writes one, whole or not at all. Throws InputError where the file cannot be written.
void write_lcm_log(const std::filesystem::path& path, const std::vector<LoggedEvent>& events);

}  // namespace flexcomp::recording
