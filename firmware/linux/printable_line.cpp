#include "linux/printable_line.hpp"

#include <cstddef>
#include <cstdint>

namespace flexcomp {
namespace {

struct Character {
  std::uint32_t code;
  std::size_t bytes;  ///< zero: not UTF-8
};

/// The UTF-8 character that a text begins with (RFC 3629): shortest form, no surrogates.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) {
    return {byte(0), 1};
  }
  const std::size_t bytes = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < bytes) {
    return {0, 0};
  }
  std::uint32_t code = byte(0) & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) {
      return {0, 0};
    }
    code = code << 6 | (byte(i) & 0x3FU);
  }
  const bool is_shortest = bytes == 2 || code >= (bytes == 3 ? 0x800U : 0x10000U);
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return {code, is_shortest && !is_surrogate && code <= 0x10FFFF ? bytes : 0};
}

bool is_printable(std::uint32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7F && code <= 0x9F);
  const bool ends_a_line = code == 0x2028 || code == 0x2029;
  const bool turns_round = code == 0x061C || code == 0x200E || code == 0x200F ||
                           (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  return !is_control && !ends_a_line && !turns_round;
}

bool is_space(char c) { return c == '\t' || c == '\n' || c == '\v' || c == '\f' || c == '\r'; }

}  // namespace

std::string printable_line(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const Character character = first_of(text);
    if (character.bytes > 0 && is_printable(character.code)) {
      shown += text.substr(0, character.bytes);
    } else {
      shown += is_space(text.front()) ? ' ' : '?';
    }
    text.remove_prefix(character.bytes > 0 ? character.bytes : 1);
  }
  return shown;
}

}  // namespace flexcomp
