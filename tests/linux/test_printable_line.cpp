#include "linux/printable_line.hpp"
#include "unity_main.hpp"

using flexcomp::printable_line;

namespace {

void assert_shown(const char* expected, const std::string& text) {
  TEST_ASSERT_EQUAL_STRING(expected, printable_line(text).c_str());
}

void what_people_write_stays_as_it_is() {
  assert_shown("", "");
  assert_shown("t.fct:3: 'period': 1e-3", "t.fct:3: 'period': 1e-3");
  assert_shown("1.5 µm, 3 N·m, ±0.1°, größer, 刀具, 🤖",
               "1.5 µm, 3 N·m, ±0.1°, größer, 刀具, 🤖");
}

void line_ends_and_tabs_become_spaces() { assert_shown("a b  c d", "a\nb\r\nc\td"); }

void no_control_character_is_left() {
  for (int byte = 0; byte < 256; ++byte) {
    const std::string shown = printable_line(std::string(1, static_cast<char>(byte)));
    TEST_ASSERT_EQUAL(1, shown.size());
    TEST_ASSERT_TRUE(shown[0] >= 0x20 && shown[0] < 0x7F);
  }
  assert_shown("?]0;owned??[2J%n", "\033]0;owned\007\033[2J%n");
  assert_shown("?", "\xC2\x9B");  // the C1 character that begins a sequence on its own
  assert_shown("a?b",
               "a\xE2\x80\xAE"
               "b");  // writes backwards from here on
  assert_shown("a?b",
               "a\xE2\x80\xA8"
               "b");  // ends a line in Unicode
}

void bytes_that_are_not_utf8_become_question_marks() {
  assert_shown("??", "\xC0\x80");            // not the shortest form
  assert_shown("???", "\xED\xA0\x80");       // a surrogate
  assert_shown("????", "\xF4\x90\x80\x80");  // beyond Unicode
  assert_shown("a??", "a\xE2\x82");          // cut off
  assert_shown("?a",
               "\xC3"
               "a");
  assert_shown("??", "\xFF\xFE");
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_people_write_stays_as_it_is);
  RUN_TEST(line_ends_and_tabs_become_spaces);
  RUN_TEST(no_control_character_is_left);
  RUN_TEST(bytes_that_are_not_utf8_become_question_marks);
  return UNITY_END();
}
