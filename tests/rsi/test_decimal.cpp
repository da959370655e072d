#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "rsi/decimal.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kUntouched = -77;

double read(const std::string& text) {
  double value = kUntouched;
  return read_decimal(text, &value) ? value : kUntouched;
}

std::uint64_t read_whole(const std::string& text) {
  std::uint64_t value = 77;
  return read_unsigned(text, &value) ? value : 77;
}

void numbers_are_read_as_the_c_library_reads_them() {
  for (const char* text : {"0", "-0.0", "1", "+1.5", "-90.0", ".5", "5.", "1e3", "-1.25E-2",
                           "123456.7891", "0.0001", "179.9999", "1e22", "9007199254740992"}) {
    TEST_ASSERT_EQUAL_DOUBLE(std::strtod(text, nullptr), read(text));
  }
}

void numbers_with_many_digits_are_read_to_the_last_places() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-250, 250);
  for (int i = 0; i < 10'000; ++i) {
    char text[64];
    std::snprintf(text, sizeof text, "%.20g", std::pow(10, exponent(random)));
    const double expected = std::strtod(text, nullptr);
    TEST_ASSERT_TRUE(std::abs(read(text) - expected) <= 1e-14 * std::abs(expected));
  }
}

void degrees_with_six_decimals_are_read_exactly() {
  for (int micro = -200'000'000; micro < 200'000'000; micro += 999'983) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6f", micro / 1e6);
    TEST_ASSERT_TRUE(read(text) == std::strtod(text, nullptr));
  }
}

void blanks_around_a_number_are_passed_over() {
  TEST_ASSERT_EQUAL_DOUBLE(1.5, read(" \t\r\n1.5\n "));
}

void what_is_no_number_is_refused() {
  for (const char* text : {"",    " ",   ".",     "-",     "+",     "e5",           "1e",  "1e+",
                           "nan", "NaN", "inf",   "-inf",  "0x10",  "1,5",          "1 5", "1.2.3",
                           "--1", "1-",  "1e5.0", "&#49;", "1e301", "1e99999999999"}) {
    TEST_ASSERT_TRUE_MESSAGE(read(text) == kUntouched, text);
  }
}

void a_number_of_more_than_64_characters_is_refused() {
  TEST_ASSERT_EQUAL_DOUBLE(1, read("1." + std::string(62, '0')));
  TEST_ASSERT_TRUE(read("1." + std::string(63, '0')) == kUntouched);
}

void what_is_too_small_to_tell_from_zero_is_zero() {
  TEST_ASSERT_EQUAL_DOUBLE(0, read("1e-99999"));
  TEST_ASSERT_EQUAL_DOUBLE(0, read("0e99999"));
}

void whole_numbers_are_read_up_to_the_largest() {
  TEST_ASSERT_TRUE(read_whole("0") == 0);
  TEST_ASSERT_TRUE(read_whole(" 4208163634 ") == 4208163634U);
  TEST_ASSERT_TRUE(read_whole("18446744073709551615") == 18446744073709551615U);
  for (const char* text : {"", "-1", "+1", "1.0", "1e3", "18446744073709551616", "0x1"}) {
    TEST_ASSERT_TRUE_MESSAGE(read_whole(text) == 77, text);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(numbers_are_read_as_the_c_library_reads_them);
  RUN_TEST(numbers_with_many_digits_are_read_to_the_last_places);
  RUN_TEST(degrees_with_six_decimals_are_read_exactly);
  RUN_TEST(blanks_around_a_number_are_passed_over);
  RUN_TEST(what_is_no_number_is_refused);
  RUN_TEST(a_number_of_more_than_64_characters_is_refused);
  RUN_TEST(what_is_too_small_to_tell_from_zero_is_zero);
  RUN_TEST(whole_numbers_are_read_up_to_the_largest);
  return UNITY_END();
}
