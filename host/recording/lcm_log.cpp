#include "recording/lcm_log.hpp"

#include <fmt/format.h>

#include <limits>
#include <string_view>

#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::recording {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;  // sync, number (8), time (8), two lengths
constexpr std::size_t kLargestFile = std::size_t{4} << 30;
constexpr std::uint64_t kLatestTime = std::numeric_limits<std::int64_t>::max() / 1000;  // µs

/// A big-endian number of `bytes` bytes.
std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) {
    value = value << 8 | static_cast<unsigned char>(byte);
  }
  return value;
}

void append_big_endian(std::uint64_t value, int bytes, std::string* text) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    text->push_back(static_cast<char>(value >> shift & 0xFFU));
  }
}

}  // namespace

std::vector<LoggedEvent> read_lcm_log(const std::filesystem::path& path) {
  const std::string content = files::read_file(path, kLargestFile);
  std::string_view rest = content;
  std::vector<LoggedEvent> events;
  while (!rest.empty()) {
    const auto fail = [&](const char* what) {
      throw InputError(
          fmt::format("{}: byte {}: {}", path.string(), content.size() - rest.size(), what));
    };
    if (rest.size() < kHeaderBytes) {
      fail("the log ends within an event");
    }
    if (big_endian(rest.substr(0, 4)) != kSync) {
      fail("expected an event of an LCM log");
    }
    const auto channel_size = static_cast<std::size_t>(big_endian(rest.substr(20, 4)));
    const auto data_size = static_cast<std::size_t>(big_endian(rest.substr(24, 4)));
    if (channel_size + data_size > rest.size() - kHeaderBytes) {
      fail("the log ends within an event");
    }
    const std::uint64_t time = big_endian(rest.substr(12, 8));
    if (time > kLatestTime) {
      fail("the time of the event is out of range");
    }
    LoggedEvent event;
    event.time = 1000 * static_cast<std::int64_t>(time);
    event.channel = rest.substr(kHeaderBytes, channel_size);
    const std::string_view data = rest.substr(kHeaderBytes + channel_size, data_size);
    event.data.assign(data.begin(), data.end());
    events.push_back(std::move(event));
    rest.remove_prefix(kHeaderBytes + channel_size + data_size);
  }
  return events;
}

void write_lcm_log(const std::filesystem::path& path, const std::vector<LoggedEvent>& events) {
  files::write_file(path, [&](std::ostream& stream) {
    std::uint64_t number = 0;
    for (const LoggedEvent& event : events) {
      std::string header;
      append_big_endian(kSync, 4, &header);
      append_big_endian(number++, 8, &header);
      append_big_endian(static_cast<std::uint64_t>(event.time / 1000), 8, &header);
      append_big_endian(event.channel.size(), 4, &header);
      append_big_endian(event.data.size(), 4, &header);
      stream << header << event.channel;
      stream.write(reinterpret_cast<const char*>(event.data.data()),
                   static_cast<std::streamsize>(event.data.size()));
    }
  });
}

}  // namespace flexcomp::recording
