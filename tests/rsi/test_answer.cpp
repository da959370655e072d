#include <cmath>
#include <cstdlib>
#include <string>

#include "rsi/answer.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

std::string written(const RsiAnswer& answer) {
  RsiAnswerText text;
  text.write(answer);
  return std::string(text.text());
}

RsiAnswer answer_with(double degrees) {
  RsiAnswer answer;
  answer.type = "ImFree";
  answer.correction[0] = degrees;
  return answer;
}

void an_answer_has_the_corrections_in_degrees_and_the_same_ipoc() {
  RsiAnswer answer = answer_with(0.5);
  answer.correction = {0.5, -0.25, 0, 1e-6, -12.345678, 359.9999996};
  answer.ipoc = 4208163634;
  TEST_ASSERT_EQUAL_STRING(
      "<Sen Type=\"ImFree\"><AK A1=\"0.500000\" A2=\"-0.250000\" A3=\"0.000000\" A4=\"0.000001\" "
      "A5=\"-12.345678\" A6=\"360.000000\"/><IPOC>4208163634</IPOC></Sen>",
      written(answer).c_str());
}

void the_state_is_told_where_it_has_a_name() {
  RsiAnswer answer = answer_with(0);
  answer.state_name = "State";
  answer.state = 2;
  TEST_ASSERT_TRUE(written(answer).find("/><State>2</State><IPOC>0</IPOC>") != std::string::npos);
}

void the_element_of_the_corrections_may_have_another_name() {
  RsiAnswer answer = answer_with(0);
  answer.correction_name = "AKorr";
  TEST_ASSERT_TRUE(written(answer).find("\"><AKorr A1=\"0.000000\"") != std::string::npos);
}

void what_is_written_is_the_number_to_half_its_last_place() {
  for (double degrees = -2; degrees < 2; degrees += 0.000'377) {
    const std::string text = written(answer_with(degrees));
    const double read = std::strtod(text.c_str() + text.find("A1=\"") + 4, nullptr);
    TEST_ASSERT_TRUE(std::abs(read - degrees) <= 0.5e-6 * (1 + 1e-9));
  }
}

void what_rounds_to_zero_has_no_sign() {
  TEST_ASSERT_TRUE(written(answer_with(-4e-7)).find('-') == std::string::npos);
}

void the_largest_answer_is_written_whole() {
  const std::string name(RsiAnswerText::kLongestName, 'n');
  RsiAnswer answer;
  answer.type = name;
  answer.correction_name = name;
  answer.state_name = name;
  answer.state = 255;
  answer.correction.fill(-360);
  answer.ipoc = ~std::uint64_t{0};
  const std::string text = written(answer);
  TEST_ASSERT_EQUAL_STRING("<IPOC>18446744073709551615</IPOC></Sen>",
                           text.substr(text.size() - 39).c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(an_answer_has_the_corrections_in_degrees_and_the_same_ipoc);
  RUN_TEST(the_state_is_told_where_it_has_a_name);
  RUN_TEST(the_element_of_the_corrections_may_have_another_name);
  RUN_TEST(what_is_written_is_the_number_to_half_its_last_place);
  RUN_TEST(what_rounds_to_zero_has_no_sign);
  RUN_TEST(the_largest_answer_is_written_whole);
  return UNITY_END();
}
