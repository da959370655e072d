// Formulas of a person: values against C++ itself, and complaints that name the column.
#include <cmath>
#include <string>

#include "formula/course.hpp"
#include "formula/dimensions.hpp"
#include "formula/proportion.hpp"
#include "unity_main.hpp"

using namespace flexcomp::formula;

namespace {

double value_of(const std::string& text, const std::vector<double>& values = {}) {
  const Formula formula(text);
  return Course(formula).next(values, 0);
}

/// The complaint of a formula's reader: "column: why".
template <typename Read>
std::string complaint(const Read& read) {
  try {
    read();
  } catch (const FormulaError& error) {
    return std::to_string(error.column()) + ": " + error.what();
  }
  return "none";
}

void expect_refused(const std::string& text, const std::string& beginning) {
  const std::string found = complaint([&] { const Formula formula(text); });
  TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(beginning.c_str(), found.c_str(), beginning.size(),
                                       (text + " -> " + found).c_str());
}

void operators_bind_as_in_mathematics() {
  TEST_ASSERT_EQUAL_DOUBLE(2 + 3 * 4.0, value_of("2 + 3*4"));
  TEST_ASSERT_EQUAL_DOUBLE((2 + 3) * 4.0, value_of("(2+3)*4"));
  TEST_ASSERT_EQUAL_DOUBLE(10 - 4 - 3.0, value_of("10 - 4 - 3"));
  TEST_ASSERT_EQUAL_DOUBLE(16 / 4 / 2.0, value_of("16/4/2"));
  TEST_ASSERT_EQUAL_DOUBLE(-4, value_of("-2^2"));
  TEST_ASSERT_EQUAL_DOUBLE(512, value_of("2^3^2"));
  TEST_ASSERT_EQUAL_DOUBLE(0.25, value_of("2^-2"));
}

void functions_and_names_have_their_values() {
  const std::vector<double> ab = {0.7, -1.3};
  const double a = ab[0];
  const double b = ab[1];
  TEST_ASSERT_EQUAL_DOUBLE(a * std::sin(b) + std::abs(b), value_of("a*sin(b) + abs(b)", ab));
  TEST_ASSERT_EQUAL_DOUBLE(std::tanh(a) - std::exp(b) + std::log(a),
                           value_of("tanh(a) - exp (b) + log(a)", ab));
  TEST_ASSERT_EQUAL_DOUBLE(std::cos(M_PI * a) + 0 * b, value_of("cos(pi*a) + 0*b", ab));
  TEST_ASSERT_EQUAL_DOUBLE(a - b, value_of("max(a, b) - min(a, b)", ab));
  TEST_ASSERT_EQUAL_DOUBLE(1 - 1 + 0, value_of("step(a) + sign(b) + step(b)", ab));
  TEST_ASSERT_EQUAL_DOUBLE(1.5e-6, value_of("1.5e-6"));
}

void what_is_wrong_is_told_with_its_column() {
  expect_refused("", "1: expected a formula");
  expect_refused("a +", "4: it ends here");
  expect_refused("a b", "3: expected an operator");
  expect_refused("2a", "2: expected an operator");
  expect_refused("a * (b + c", "11: expected a closing bracket");
  expect_refused("a)", "2: unexpected bracket");
  expect_refused("a + *b", "5: expected a number");
  expect_refused("a + twice(b)", "5: 'twice' is no function");
  expect_refused("a*sin", "3: 'sin' is a function");
  expect_refused("lag(a)", "6: lag takes 2 arguments");
  expect_refused("sin(a, b)", "9: sin takes 1 argument");
  expect_refused("a, b", "2: expected one value");
  expect_refused("a = 3", "3: unexpected '='");
  expect_refused("a ? b : c", "3: unexpected '?'");
  expect_refused("\"a\"", "1: unexpected");
  expect_refused("a*\xC3\xA9", "3: unexpected '?'");
  expect_refused("1e999", "1: expected a number");
  expect_refused(std::string(2000, '1'), "1001: expected at most 1000");
  expect_refused(std::string(200, '(') + "a" + std::string(200, ')'), "101: expected at most 100");
}

std::vector<std::optional<Dimension>> known(const std::vector<std::string>& units) {
  std::vector<std::optional<Dimension>> all;
  for (const std::string& unit : units) {
    all.push_back(unit.empty() ? std::nullopt : std::optional<Dimension>(dimension_of(unit)));
  }
  return all;
}

/// The check's answer to a formula whose names have these units, in the order of their appearance.
std::string units_of(const std::string& text, const std::vector<std::string>& units,
                     const std::string& wanted) {
  std::string found;
  const std::string why = complaint([&] {
    for (const auto& each :
         check_dimensions(Formula(text), known(units), dimension_of(wanted), "joint_torque")) {
      found += (found.empty() ? "" : " ") + (each ? unit_text(*each) : "open");
    }
  });
  return why == "none" ? found : why;
}

void units_are_read_as_people_write_them() {
  const auto same = [](const char* a, const char* b) {
    TEST_ASSERT_TRUE_MESSAGE(is_same(dimension_of(a), dimension_of(b)), a);
  };
  same("N·m", "kg*m^2/s^2");
  same("N·m·s/rad", "J*s");
  same("rad/(N·m)^2", "1/J^2");
  same("m/s²", "N/kg");
  same("W", "N·m·rad/s");
  same("1", "rad");
  TEST_ASSERT_EQUAL_STRING("1: 'Nm' is no SI unit",
                           complaint([] { dimension_of("Nm"); }).substr(0, 21).c_str());
  TEST_ASSERT_EQUAL_STRING("N·m", unit_text(dimension_of("J")).c_str());
  TEST_ASSERT_EQUAL_STRING("m/N", unit_text(dimension_of("m/N")).c_str());
  TEST_ASSERT_EQUAL_STRING("m/s^2", unit_text(dimension_of("m/s²")).c_str());
}

void units_that_are_not_given_follow_from_the_formula() {
  const std::vector<std::string> open = {"", "rad", "", "rad/s", "N·m"};
  TEST_ASSERT_EQUAL_STRING("N·m 1 s 1/s N·m",
                           units_of("a*sin(q4) + b*v5*abs(tau5)", open, "N·m").c_str());
  TEST_ASSERT_EQUAL_STRING("N·m 1/s 1/s",
                           units_of("a*tanh(v5/b)", {"", "rad/s", ""}, "N·m").c_str());
  TEST_ASSERT_EQUAL_STRING("open open 1", units_of("a*b*q1", {"", "", "rad"}, "N·m").c_str());
  TEST_ASSERT_EQUAL_STRING("1 N·m", units_of("a*max(0, tau5)", {"", "N·m"}, "N·m").c_str());
}

void units_that_disagree_are_told_with_their_column() {
  const auto expect = [](const std::string& beginning, const std::string& found) {
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(beginning.c_str(), found.c_str(), beginning.size(),
                                         found.c_str());
  };
  expect("7: 'v5' is in 1/s; the argument of sin", units_of("2*sin(v5)", {"rad/s"}, "1"));
  expect("8: 'v5' is in 1/s, but 'tau5' in N·m", units_of("tau5 + v5", {"N·m", "rad/s"}, "N·m"));
  expect("1: it is in N·m/s; joint_torque needs N·m", units_of("a*v5", {"N·m", "rad/s"}, "N·m"));
  expect("11: 'q1' is in rad or a plain number; the second argument of lag",
         units_of("lag(tau5, q1)", {"N·m", "rad"}, "N·m"));
}

std::string proportional(const std::string& text, const std::vector<std::string>& candidates) {
  const Formula formula(text);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < formula.names().size(); ++i) {
    for (const std::string& candidate : candidates) {
      if (formula.names()[i] == candidate) {
        indices.push_back(i);
      }
    }
  }
  std::string found;
  for (const std::size_t index : in_proportion(formula, indices)) {
    found += formula.names()[index];
  }
  return found;
}

void the_parameters_that_act_in_proportion_are_found() {
  TEST_ASSERT_EQUAL_STRING("ab", proportional("a*sin(q) + b*v*abs(u)", {"a", "b"}).c_str());
  TEST_ASSERT_EQUAL_STRING("a", proportional("a*sin(n*q + p)", {"a", "n", "p"}).c_str());
  TEST_ASSERT_EQUAL_STRING("a", proportional("a*b*q", {"a", "b"}).c_str());
  TEST_ASSERT_EQUAL_STRING("", proportional("a*q + 1", {"a"}).c_str());
  TEST_ASSERT_EQUAL_STRING("", proportional("abs(a)*q", {"a"}).c_str());
  TEST_ASSERT_EQUAL_STRING("ab", proportional("-(a*q - b)/n", {"a", "b", "n"}).c_str());
  TEST_ASSERT_EQUAL_STRING("a", proportional("lag(a*q, n)", {"a", "n"}).c_str());
}

void a_lag_follows_a_ramp_by_its_closed_form() {
  const Formula formula("lag(x, T)");
  Course course(formula);
  const double constant = 0.3;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.013 * i;
    const double wanted = 2 * (t - constant * (1 - std::exp(-t / constant)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, wanted, course.next({2 * t, constant}, 0.013));
  }
}

void a_lag_that_begins_ahead_catches_up() {
  const Formula formula("lag(x, T)");
  Course course(formula, 0.5);
  const double constant = 0.3;
  for (int i = 0; i <= 200; ++i) {
    const double wanted = 2 + 0.5 * std::exp(-0.013 * i / constant);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, wanted, course.next({2, constant}, 0.013));
  }
}

void play_holds_at_a_reversal() {
  const Formula formula("play(x, gap)");
  Course course(formula);
  const std::vector<double> inputs = {0, 1, 0.9, 0.5, 0.2};
  const std::vector<double> wanted = {0, 0.8, 0.8, 0.7, 0.4};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, wanted[i], course.next({inputs[i], 0.4}, 0.01));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(operators_bind_as_in_mathematics);
  RUN_TEST(functions_and_names_have_their_values);
  RUN_TEST(what_is_wrong_is_told_with_its_column);
  RUN_TEST(units_are_read_as_people_write_them);
  RUN_TEST(units_that_are_not_given_follow_from_the_formula);
  RUN_TEST(units_that_disagree_are_told_with_their_column);
  RUN_TEST(the_parameters_that_act_in_proportion_are_found);
  RUN_TEST(a_lag_follows_a_ramp_by_its_closed_form);
  RUN_TEST(a_lag_that_begins_ahead_catches_up);
  RUN_TEST(play_holds_at_a_reversal);
  return UNITY_END();
}
