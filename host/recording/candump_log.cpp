#include "recording/candump_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"

namespace flexcomp::recording {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::size_t kStandardDigits = 3;
constexpr std::size_t kExtendedDigits = 8;
/// Each has a decoder of its own, of some KB: a log of millions would take all memory.
constexpr std::size_t kMostInterfaces = 64;

/// A whole text as an unsigned number.
template <typename Number>
bool parse(std::string_view text, int base, Number* number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *number, base);
  return error == std::errc() && end == text.data() + text.size();
}

/// "1436509052.249713" in ns: no more digits than nine behind the point.
bool parse_time(std::string_view text, std::int64_t* time) {
  const std::size_t point = text.find('.');
  std::uint32_t seconds = 0;
  std::uint32_t fraction = 0;
  if (point == std::string_view::npos || !parse(text.substr(0, point), 10, &seconds)) {
    return false;
  }
  const std::string_view digits = text.substr(point + 1);
  if (digits.empty() || digits.size() > 9 || !parse(digits, 10, &fraction)) {
    return false;
  }
  std::int64_t nanoseconds = fraction;
  for (std::size_t i = digits.size(); i < 9; ++i) {
    nanoseconds *= 10;
  }
  *time = kNanosecondsPerSecond * seconds + nanoseconds;
  return true;
}

bool parse_data(std::string_view text, std::size_t largest, CanFrame* frame) {
  if (text.size() % 2 != 0 || text.size() / 2 > largest) {
    return false;
  }
  frame->size = static_cast<std::uint8_t>(text.size() / 2);
  for (std::size_t i = 0; i < frame->size; ++i) {
    if (!parse(text.substr(2 * i, 2), 16, &frame->data[i])) {
      return false;
    }
  }
  return true;
}

/// Kind of a line of a log: a frame, one that is left out, or nothing that makes sense.
enum class Line { frame, left_out, unusable };

Line parse_frame(std::string_view text, CanFrame* frame) {
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos || !parse(text.substr(0, hash), 16, &frame->id)) {
    return Line::unusable;
  }
  std::string_view data = text.substr(hash + 1);
  const bool is_remote = !data.empty() && (data[0] == 'R' || data[0] == 'r');
  if (hash == kExtendedDigits || (hash == kStandardDigits && is_remote)) {
    return Line::left_out;
  }
  frame->fd = !data.empty() && data[0] == '#';
  if (frame->fd) {
    unsigned flags = 0;
    if (data.size() < 2 || !parse(data.substr(1, 1), 16, &flags)) {
      return Line::unusable;
    }
    data.remove_prefix(2);
  }
  const bool usable = hash == kStandardDigits && parse_data(data, frame->fd ? 64 : 8, frame);
  return usable ? Line::frame : Line::unusable;
}

/// Cuts the next word off a line.
std::string_view next_word(std::string_view* line) {
  const std::size_t begin = std::min(line->find_first_not_of(" \t"), line->size());
  line->remove_prefix(begin);
  const std::string_view word = line->substr(0, line->find_first_of(" \t"));
  line->remove_prefix(word.size());
  return word;
}

Line parse_line(std::string_view line, LoggedFrame* logged) {
  const std::string_view time = next_word(&line);
  logged->interface = next_word(&line);
  const std::string_view frame = next_word(&line);
  // Newer logs have a direction, R or T, in the end.
  const std::string_view direction = next_word(&line);
  const bool bracketed = time.size() > 2 && time.front() == '(' && time.back() == ')';
  if (!bracketed || !parse_time(time.substr(1, time.size() - 2), &logged->time) ||
      direction.size() > 1 || !next_word(&line).empty()) {
    return Line::unusable;
  }
  return parse_frame(frame, &logged->frame);
}

}  // namespace

std::vector<LoggedFrame> read_candump_log(const std::filesystem::path& path) {
  const std::string text = files::read_text(path);
  std::vector<LoggedFrame> frames;
  std::set<std::string> interfaces;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    if (line.empty()) {
      continue;
    }
    LoggedFrame logged;
    const Line kind = parse_line(line, &logged);
    if (kind == Line::unusable) {
      throw InputError(
          fmt::format("{}:{}: '{}'; expected a line of candump -L: (seconds) interface id#data",
                      path.string(), number, files::one_line(line)));
    }
    if (kind == Line::frame) {
      interfaces.insert(logged.interface);
      if (interfaces.size() > kMostInterfaces) {
        throw InputError(fmt::format("{}:{}: expected at most {} interfaces", path.string(), number,
                                     kMostInterfaces));
      }
      frames.push_back(std::move(logged));
    }
  }
  return frames;
}

void write_candump_log(const std::filesystem::path& path, const std::vector<LoggedFrame>& frames) {
  files::write_file(path, [&](std::ostream& stream) {
    std::string line;
    for (const LoggedFrame& logged : frames) {
      line = fmt::format("({}.{:06}) {} {:03X}#{}", logged.time / kNanosecondsPerSecond,
                         logged.time % kNanosecondsPerSecond / 1000, logged.interface,
                         logged.frame.id, logged.frame.fd ? "#1" : "");
      for (std::size_t i = 0; i < logged.frame.size; ++i) {
        fmt::format_to(std::back_inserter(line), "{:02X}", logged.frame.data[i]);
      }
      stream << line << '\n';
    }
  });
}

}  // namespace flexcomp::recording
