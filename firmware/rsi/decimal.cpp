#include "rsi/decimal.hpp"

#include <array>
#include <cstddef>
#include <limits>

namespace flexcomp {
namespace {

constexpr std::size_t kLongest = 64;  // characters
constexpr int kLargestExponent = 300;
constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int kLargestPower = static_cast<int>(kPowersOfTen.size()) - 1;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes characters from the front of a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  bool is_at_end() const { return place_ == text_.size(); }
  bool is_at_digit() const { return !is_at_end() && is_digit(text_[place_]); }
  int take_digit() { return text_[place_++] - '0'; }
  bool take(char c) {
    const bool is_there = !is_at_end() && text_[place_] == c;
    place_ += is_there ? 1U : 0U;
    return is_there;
  }
  /// Takes a sign, where there is one; true for a minus.
  bool take_minus() {
    const bool is_minus = take('-');
    if (!is_minus) {
      take('+');
    }
    return is_minus;
  }

 private:
  std::string_view text_;
  std::size_t place_ = 0;
};

/// Digits so far, as mantissa · 10^exponent.
struct Digits {
  std::uint64_t mantissa = 0;
  int exponent = 0;
  bool any = false;

  void add(int digit, bool after_point) {
    constexpr std::uint64_t kFull = std::numeric_limits<std::uint64_t>::max() / 10 - 1;
    any = true;
    if (mantissa < kFull) {
      mantissa = 10 * mantissa + static_cast<std::uint64_t>(digit);
      exponent -= after_point ? 1 : 0;
    } else {
      exponent += after_point ? 0 : 1;  // too small to count
    }
  }
};

Digits take_digits(Cursor* cursor) {
  Digits digits;
  while (cursor->is_at_digit()) {
    digits.add(cursor->take_digit(), false);
  }
  if (cursor->take('.')) {
    while (cursor->is_at_digit()) {
      digits.add(cursor->take_digit(), true);
    }
  }
  return digits;
}

/// Adds the exponent that is written, if one is; false if it has no digits.
bool take_exponent(Cursor* cursor, int* exponent) {
  if (!cursor->take('e') && !cursor->take('E')) {
    return true;
  }
  const bool negative = cursor->take_minus();
  if (!cursor->is_at_digit()) {
    return false;
  }
  constexpr int kEnough = 10'000;
  int written = 0;
  while (cursor->is_at_digit()) {
    const int digit = cursor->take_digit();
    written = written < kEnough ? 10 * written + digit : written;
  }
  *exponent += negative ? -written : written;
  return true;
}

/// value · 10^exponent, for an exponent within a few hundred.
double scaled(double value, int exponent) {
  for (; exponent > kLargestPower; exponent -= kLargestPower) {
    value *= kPowersOfTen[kLargestPower];
  }
  for (; exponent < -kLargestPower; exponent += kLargestPower) {
    value /= kPowersOfTen[kLargestPower];
  }
  return exponent < 0 ? value / kPowersOfTen[static_cast<std::size_t>(-exponent)]
                      : value * kPowersOfTen[static_cast<std::size_t>(exponent)];
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

bool read_decimal(std::string_view text, double* value) {
  text = without_blanks(text);
  if (text.size() > kLongest) {
    return false;
  }
  Cursor cursor(text);
  const bool negative = cursor.take_minus();
  Digits digits = take_digits(&cursor);
  if (!digits.any || !take_exponent(&cursor, &digits.exponent) || !cursor.is_at_end()) {
    return false;
  }
  constexpr int kMantissaDigits = 20;
  double size = 0;
  if (digits.mantissa != 0 && digits.exponent > kLargestExponent) {
    return false;
  }
  if (digits.exponent >= -kLargestExponent - kMantissaDigits && digits.mantissa != 0) {
    size = scaled(static_cast<double>(digits.mantissa), digits.exponent);
  }
  if (size > 1e300) {
    return false;
  }
  *value = negative ? -size : size;
  return true;
}

bool read_unsigned(std::string_view text, std::uint64_t* value) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  text = without_blanks(text);
  if (text.empty() || text.size() > kLongest) {
    return false;
  }
  std::uint64_t number = 0;
  for (const char c : text) {
    const auto digit = static_cast<std::uint64_t>(c - '0');
    if (!is_digit(c) || number > (kMost - digit) / 10) {
      return false;
    }
    number = 10 * number + digit;
  }
  *value = number;
  return true;
}

}  // namespace flexcomp
