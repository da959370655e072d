#pragma once

#include <cstdint>
#include <string_view>

namespace flexcomp {

/// Reads a decimal number: sign, digits with or without a point, exponent. Blanks around it are
/// passed over. The language of the system does not matter, and nothing is allocated.
///
/// False, and `value` untouched, for all else: no digit, other characters, "nan", "inf", more than
/// 64 characters, or a size above 1e300. Correctly rounded up to 15 significant digits and powers
/// of ten up to 22; within 1e-14 of its size otherwise.
bool read_decimal(std::string_view text, double* value);

/// Reads a whole number without a sign; false for all else, and for one above 2^64 - 1.
bool read_unsigned(std::string_view text, std::uint64_t* value);

/// `text` without blanks, tabs and line ends on either side.
std::string_view without_blanks(std::string_view text);

/// Is this a blank of XML: space, tab, line feed, carriage return?
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace flexcomp
