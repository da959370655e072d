#include "messages/slcan.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kIdDigits = 3;
constexpr std::size_t kHeadSize = 1 + kIdDigits + 1;
constexpr std::uint8_t kNoDigit = 0xFF;

constexpr char kDigits[] = "0123456789ABCDEF";

/// The value of each character as a hexadecimal digit, or kNoDigit.
constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> values{};
  for (std::uint8_t& value : values) {
    value = kNoDigit;
  }
  for (std::uint8_t i = 0; i < 16; ++i) {
    const char c = kDigits[i];
    values[static_cast<std::uint8_t>(c)] = i;
    if (c >= 'A') {
      values[static_cast<std::uint8_t>(c - 'A' + 'a')] = i;
    }
  }
  return values;
}

constexpr std::array<std::uint8_t, 256> kValues = make_values();

/// Reads `count` hexadecimal digits; false if one is none.
bool read_hexadecimal(const char* text, std::size_t count, std::uint32_t* value) {
  *value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t next = kValues[static_cast<std::uint8_t>(text[i])];
    if (next == kNoDigit) {
      return false;
    }
    *value = *value << 4 | next;
  }
  return true;
}

}  // namespace

SlcanLine to_slcan(const CanFrame& frame) {
  SlcanLine line;
  if (frame.fd || frame.size > 8) {
    return line;
  }
  char* end = line.text.data();
  *end++ = 't';
  *end++ = kDigits[frame.id >> 8 & 0x7U];
  *end++ = kDigits[frame.id >> 4 & 0xFU];
  *end++ = kDigits[frame.id & 0xFU];
  *end++ = kDigits[frame.size];
  for (std::size_t i = 0; i < frame.size; ++i) {
    *end++ = kDigits[frame.data[i] >> 4];
    *end++ = kDigits[frame.data[i] & 0xFU];
  }
  *end++ = '\r';
  line.size = static_cast<std::size_t>(end - line.text.data());
  return line;
}

SlcanReader::Event SlcanReader::take(std::uint8_t byte) {
  const char c = static_cast<char>(byte);
  if (c == '\r' || c == '\a') {  // either ends an answer of an adapter
    const Event event = end_of_line();
    size_ = 0;
    return event;
  }
  if (c == '\n') {
    return Event::nothing;  // from a person at a terminal
  }
  if (size_ < kLongestLine) {
    line_[size_] = c;
  }
  size_ += size_ <= kLongestLine ? 1U : 0U;
  return Event::nothing;
}

SlcanReader::Event SlcanReader::end_of_line() {
  if (size_ == 0) {
    return Event::nothing;
  }
  if (size_ > kLongestLine) {
    return Event::corrupt;
  }
  switch (line_[0]) {
    case 't':
      return read_frame();
    case 'T':
    case 'r':
    case 'R':
      return Event::foreign;
    case 'O':
    case 'L':
    case 'C':
    case 'S':
    case 's':
    case 'V':
    case 'N':
    case 'F':
    case 'Z':
    case 'M':
    case 'm':
      return Event::command;
    default:
      return Event::unknown;
  }
}

SlcanReader::Event SlcanReader::read_frame() {
  std::uint32_t id = 0;
  std::uint32_t size = 0;
  const bool head = size_ >= kHeadSize && read_hexadecimal(&line_[1], kIdDigits, &id) &&
                    read_hexadecimal(&line_[1 + kIdDigits], 1, &size);
  if (!head || id > 0x7FFU || size > 8 || size_ != kHeadSize + 2 * size) {
    return Event::corrupt;
  }
  frame_ = CanFrame{};
  frame_.id = id;
  frame_.size = static_cast<std::uint8_t>(size);
  for (std::size_t i = 0; i < size; ++i) {
    std::uint32_t byte = 0;
    if (!read_hexadecimal(&line_[kHeadSize + 2 * i], 2, &byte)) {
      return Event::corrupt;
    }
    frame_.data[i] = static_cast<std::uint8_t>(byte);
  }
  return Event::frame;
}

}  // namespace flexcomp
