#include "messages/slcan.hpp"

#include <cstring>

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

/// The two digits of each byte, as they follow each other.
constexpr std::array<char, 512> make_pairs() {
  std::array<char, 512> pairs{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    pairs[2 * byte] = kDigits[byte >> 4];
    pairs[2 * byte + 1] = kDigits[byte & 0xFU];
  }
  return pairs;
}

constexpr std::array<char, 512> kPairs = make_pairs();

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
    std::memcpy(end, &kPairs[2U * frame.data[i]], 2);
    end += 2;
  }
  *end++ = '\r';
  line.size = static_cast<std::size_t>(end - line.text.data());
  return line;
}

std::size_t SlcanReader::take_frame(const std::uint8_t* text, std::size_t count) {
  if (size_ != 0 || count < kHeadSize || text[0] != 't') {
    return 0;
  }
  const std::size_t size = kValues[text[kHeadSize - 1]];
  const std::size_t end = kHeadSize + 2 * size;
  if (size > 8 || count <= end || text[end] != '\r') {
    return 0;
  }
  const std::uint32_t first = kValues[text[1]];
  const std::uint32_t second = kValues[text[2]];
  const std::uint32_t third = kValues[text[3]];
  std::uint32_t digits = first | second | third;  // the upper half of kNoDigit, if one is none
  frame_.id = first << 8 | second << 4 | third;
  frame_.size = static_cast<std::uint8_t>(size);
  const std::uint8_t* pair = text + kHeadSize;
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint32_t byte = 0;
    if (i < size) {
      const std::uint32_t high = *pair++;
      const std::uint32_t low = *pair++;
      digits |= static_cast<std::uint32_t>(kValues[high] | kValues[low]);
      byte = static_cast<std::uint32_t>(kValues[high]) << 4 | kValues[low];
    }
    frame_.data[i] = static_cast<std::uint8_t>(byte);
  }
  return digits > 0xFU || frame_.id > 0x7FFU ? 0 : end + 1;
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
