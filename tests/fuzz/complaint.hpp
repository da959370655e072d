#pragma once

#include <string>
#include <string_view>

#include "byte_source.hpp"
#include "error.hpp"

namespace flexcomp::fuzz {

/// Runs a reader on bad input: it may complain, in one printable line that begins with the file.
template <typename Reader>
void expect_one_line_or_none(const std::string& file, const Reader& read) {
  constexpr std::size_t kLongest = 2000;
  try {
    read();
  } catch (const InputError& error) {
    const std::string_view text = error.what();
    expect(text.size() < kLongest, "a complaint is short");
    expect(text.substr(0, file.size()) == file, "a complaint names the file first");
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      expect(byte >= 0x20 && byte != 0x7F, "a complaint is one line without control characters");
    }
  }
}

}  // namespace flexcomp::fuzz
