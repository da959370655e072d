#include <cmath>
#include <string>
#include <vector>

#include "host/scratch_folder.hpp"
#include "recording/column_map.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::recording::ForeignLayout;
using flexcomp::recording::ForeignTable;
using flexcomp::recording::map_columns;
using flexcomp::recording::Mapped;
using flexcomp::recording::Recording;
using flexcomp::test::put;
using flexcomp::test::refusal_of;
using flexcomp::test::ScratchFolder;

namespace {

using Rules = std::vector<std::string>;

Mapped mapped(const std::string& text, const Rules& rules, const ForeignLayout& layout = {}) {
  const ScratchFolder folder;
  put(folder / "a.txt", text);
  return map_columns(ForeignTable(folder / "a.txt", layout), rules);
}

Recording recording(const std::string& text, const Rules& rules, const ForeignLayout& layout = {}) {
  return mapped(text, rules, layout).recording;
}

/// Complaint, with the file's folder taken off.
std::string refusal(const std::string& text, const Rules& rules) {
  const ScratchFolder folder;
  put(folder / "a.txt", text);
  std::string said = refusal_of([&] { map_columns(ForeignTable(folder / "a.txt", {}), rules); });
  const std::string place = (folder / "").string();
  for (std::size_t at = said.find(place); at != std::string::npos; at = said.find(place)) {
    said.erase(at, place.size());
  }
  return said;
}

void expect_refusal(const char* reason, const std::string& text, const Rules& rules) {
  TEST_ASSERT_EQUAL_STRING(reason, refusal(text, rules).c_str());
}

void close(double expected, double found) { TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected, found); }

double only_x(const std::string& cell, const std::string& unit = "") {
  const Rules rules = {"t=t", "x=p" + unit, "y=p", "z=p"};
  return (*recording("t;p\n0;" + cell + "\n", rules).position)(0, 0);
}

void semicolons_and_decimal_commas_are_read() {
  const Recording rows =
      recording("Zeit;A1\n0,004;-12,5\n0,008;1,5e1\n", {"t=Zeit", "q_meas_1=A1:deg"});
  close(0.004, rows.time[1]);
  close(-12.5 * std::acos(-1.0) / 180, (*rows.q_meas)(0, 0));
  close(15 * std::acos(-1.0) / 180, (*rows.q_meas)(1, 0));
}

void tabs_blanks_quotes_and_windows_line_ends_are_read() {
  const Rules rules = {"t=time", "tau_1=M 1"};
  close(7, (*recording("time\tM 1\r\n0\t7\r\n", rules).tau)(0, 0));
  close(7, (*recording("\"time\",\"M 1\"\n\"0\",\"7\"\n", rules).tau)(0, 0));
  close(7, (*recording("\"time\",\"M \"\"1\"\n0,7\n", {"t=time", "tau_1=M \"1"}).tau)(0, 0));
  close(7, (*recording("# time m1\n 0.0   7 \n", {"t=time", "tau_1=m1"}).tau)(0, 0));
}

void a_separator_at_the_end_of_every_line_is_skipped() {
  close(7, (*recording("time;m1;\n0;7;\n", {"t=time", "tau_1=m1"}).tau)(0, 0));
}

void lines_above_the_names_and_units_below_are_skipped() {
  const std::string text = "made by a drive\n\ntime;m1\n[s];[Nm]\n0;7\n";
  const Recording rows = recording(text, {"t=time", "tau_1=m1"}, {3, 5, {}});
  TEST_ASSERT_EQUAL_INT(1, rows.size());
  close(7, (*rows.tau)(0, 0));
}

void text_in_columns_that_no_rule_names_does_not_matter() {
  const Mapped rows = mapped("t,state,m1\n0,running,7\n", {"t=t", "tau_1=m1"});
  close(7, (*rows.recording.tau)(0, 0));
  TEST_ASSERT_EQUAL_UINT(1, rows.left_out.size());
  TEST_ASSERT_EQUAL_STRING("state", rows.left_out[0].c_str());
}

void a_star_stands_for_the_joint_from_one_or_from_zero() {
  const Recording from_one = recording("t,q1,q2\n0,1,2\n", {"t=t", "q_cmd_*=q*"});
  TEST_ASSERT_EQUAL_INT(2, from_one.q_cmd->cols());
  close(2, (*from_one.q_cmd)(0, 1));
  const Recording from_zero =
      recording("t,q[0],q[1],q[2]\n0,1,2,3\n", {"t=t", "q_cmd_*=q[*]:deg*-1"});
  TEST_ASSERT_EQUAL_INT(3, from_zero.q_cmd->cols());
  close(-3 * std::acos(-1.0) / 180, (*from_zero.q_cmd)(0, 2));
}

void a_rule_for_one_joint_goes_before_one_for_all() {
  for (const Rules& rules : {Rules{"t=t", "q_cmd_*=q*", "q_cmd_2=q2:*-1+10"},
                             Rules{"t=t", "q_cmd_2=q2:*-1+10", "q_cmd_*=q*"}}) {
    const Recording rows = recording("t,q1,q2,q3\n0,1,2,3\n", rules);
    TEST_ASSERT_EQUAL_INT(3, rows.q_cmd->cols());
    close(1, (*rows.q_cmd)(0, 0));
    close(8, (*rows.q_cmd)(0, 1));
    close(3, (*rows.q_cmd)(0, 2));
  }
  expect_refusal("--map q_cmd_*=w*: column 'q_cmd_1' has a rule already", "t,q1,w1\n0,1,2\n",
                 {"t=t", "q_cmd_*=q*", "q_cmd_*=w*"});
}

void a_name_may_have_a_colon() {
  close(7, (*recording("t,arm:1\n0,7\n", {"t=t", "tau_1=arm:1"}).tau)(0, 0));
  close(7000, (*recording("t,arm:1\n0,7\n", {"t=t", "tau_1=arm:1:kNm"}).tau)(0, 0));
}

void units_are_those_of_the_standards() {
  close(0.0123, only_x("12.3", ":mm"));
  close(12.3e-6, only_x("12.3", ":um"));
  close(0.0254, only_x("1", ":in"));
  close(4.4482216152605,
        (*recording("t,f\n0,1\n", {"t=t", "fx=f:lbf", "fy=f", "fz=f", "mx=f", "my=f", "mz=f:Nmm"})
              .wrench)(0, 0));
  close(-17.77777777777778, (*recording("t,T\n0,0\n", {"t=t", "temp_c=T:F"}).temperature)(0, 0));
  close(-273.15, (*recording("t,T\n0,0\n", {"t=t", "temp_c=T:K"}).temperature)(0, 0));
  close(125, (*recording("t,load\n0,50\n", {"t=t", "tau_1=load:%*250"}).tau)(0, 0));
  close(-3.2, (*recording("t,current\n0,4\n", {"t=t", "tau_1=current:*-0.8"}).tau)(0, 0));
}

void an_offset_is_added_in_the_unit_after_the_factor() {
  const double degree = std::acos(-1.0) / 180;
  const auto angle = [](const std::string& rule) {
    return (*recording("t,A2\n0,-100\n", {"t=t", "q_cmd_1=A2" + rule}).q_cmd)(0, 0);
  };
  close(10 * degree, angle(":deg*-1-90"));
  close(-10 * degree, angle(":deg+90"));
  close(-99.5, angle(":+0.5"));
  close(-49, angle(":*0.5+1"));
  close(-0.09, angle(":*1e-3+1e-2"));
  close(-17.77777777777778 + 5.0 / 9,
        (*recording("t,T\n0,0\n", {"t=t", "temp_c=T:F+1"}).temperature)(0, 0));
}

void stamps_since_an_epoch_count_from_the_first_row() {
  const std::string text = "sec,nsec,m1\n1700000000,999000001,1\n1700000001,1,2\n";
  const Recording rows = recording(text, {"t=sec", "t=nsec:ns", "tau_1=m1"});
  TEST_ASSERT_EQUAL_DOUBLE(0, rows.time[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.001, rows.time[1]);
  close(0.25, recording("t,m1\n5000,1\n5250,2\n", {"t=t:ms", "tau_1=m1"}).time[1]);
}

void missing_cells_stay_missing() {
  for (const char* cell : {"", "nan", "NaN", "NA", "n/a", "null", "None"}) {
    TEST_ASSERT_TRUE_MESSAGE(std::isnan(only_x(cell)), cell);
  }
}

void what_is_no_number_is_refused_with_its_place() {
  expect_refusal("a.txt:3: column 'm': 'off' is not a finite number", "t,m\n0,1\n1,off\n",
                 {"t=t", "tau_1=m"});
  expect_refusal(
      "a.txt:2: column 'm': 'Nm' is not a finite number; if this is a line of units, --first-row 3",
      "t,m\n0,Nm\n0,1\n", {"t=t", "tau_1=m"});
  expect_refusal("a.txt:3: column 'm': 'inf' is not a finite number", "t,m\n0,1\n1,inf\n",
                 {"t=t", "tau_1=m"});
  expect_refusal("a.txt:3: column 'm': '+-1' is not a finite number", "t,m\n0,1\n1,+-1\n",
                 {"t=t", "tau_1=m"});
}

void a_separator_of_thousands_is_refused() {
  const Rules rules = {"t=t", "tau_1=m"};
  expect_refusal("a.txt:2: column 'm': '1.234,5' is not a finite number", "t;m\n0;1.234,5\n",
                 rules);
  expect_refusal("a.txt:3: column 'm': '1,234' is not a finite number", "t;m\n0;0.5\n1;1,234\n",
                 rules);
}

void rows_that_do_not_fit_the_names_are_refused() {
  const Rules rules = {"t=t", "tau_1=m"};
  expect_refusal("a.txt:2: expected 2 cells as there are names, found 3", "t,m\n0,1,2\n", rules);
  expect_refusal("a.txt:2: a quote does not end where its cell ends", "t,m\n0,\"1\n", rules);
  expect_refusal("a.txt:2: a quote does not end where its cell ends", "t,m\n0,\"1\"2\n", rules);
  expect_refusal("a.txt: no rows below the names", "t,m\n", rules);
}

void rules_that_cannot_be_followed_are_refused() {
  const std::string text = "t,m,m,q1\n0,1,2,3\n";
  expect_refusal("--map t: expected COLUMN=NAME or COLUMN=NAME:UNIT", text, {"t"});
  expect_refusal(
      "--map q1=q1: 'q1' is no column of a recording; expected t, q_cmd_1, q_meas_1, "
      "q_link_1, tau_1, fx to mz, x, y, z, temp_c or line",
      text, {"q1=q1"});
  expect_refusal("--map t=time: a.txt has no column 'time'; it has t, m, m, q1", text, {"t=time"});
  expect_refusal("--map tau_1=m: a.txt has more than one column 'm'", text, {"tau_1=m"});
  expect_refusal("--map q_cmd_1=t: column 'q_cmd_1' has a rule already", text,
                 {"q_cmd_1=q1", "q_cmd_1=t"});
  expect_refusal("--map q_cmd_*=q1: expected * for the joint's number on both sides, or on none",
                 text, {"q_cmd_*=q1"});
  expect_refusal("--map q_cmd_*=w*: a.txt has no column 'w1'; it has t, m, m, q1", text,
                 {"q_cmd_*=w*"});
  expect_refusal("--map q_cmd_13=q1: a robot has at most 12 joints", text, {"q_cmd_13=q1"});
}

void units_that_do_not_fit_are_refused() {
  const std::string text = "t,m\n0,1\n";
  expect_refusal("--map t=t:min: unit 'min': expected s, ms, us, ns", text, {"t=t:min"});
  expect_refusal("--map x=m:deg: unit 'deg': expected m, mm, um, in", text, {"x=m:deg"});
  expect_refusal("--map tau_1=m:%: unit '%': percent of what? Say what 100 % is: %*250", text,
                 {"tau_1=m:%"});
  expect_refusal("--map tau_1=m:*0: factor '0': expected a number that is not zero", text,
                 {"tau_1=m:*0"});
  expect_refusal("--map tau_1=m:*1x: factor '1x': expected a number that is not zero", text,
                 {"tau_1=m:*1x"});
  for (const char* offset : {"+", "-", "+x", "--1", "+1x", "+1+1", "+inf"}) {
    expect_refusal(
        (std::string("--map tau_1=m:Nm") + offset + ": offset '" + offset + "': expected a number")
            .c_str(),
        text, {std::string("tau_1=m:Nm") + offset});
  }
}

void what_is_no_recording_is_refused_with_its_line() {
  expect_refusal("a.txt:3: column 'tau_1' is beyond all numbers in its unit", "t,m\n0,1\n1,1e300\n",
                 {"t=t", "tau_1=m:*1e9"});
  expect_refusal("a.txt:1: column 't' is missing", "t,m\n0,1\n", {"tau_1=m"});
  expect_refusal("a.txt:3: column 't': time must increase, found 0 after 0", "t,m\n3,1\n3,1\n",
                 {"t=t", "tau_1=m"});
  expect_refusal("a.txt:1: column 'z' is missing; x to z belong together", "t,m\n0,1\n",
                 {"t=t", "x=m", "y=m"});
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(semicolons_and_decimal_commas_are_read);
  RUN_TEST(tabs_blanks_quotes_and_windows_line_ends_are_read);
  RUN_TEST(a_separator_at_the_end_of_every_line_is_skipped);
  RUN_TEST(lines_above_the_names_and_units_below_are_skipped);
  RUN_TEST(text_in_columns_that_no_rule_names_does_not_matter);
  RUN_TEST(a_star_stands_for_the_joint_from_one_or_from_zero);
  RUN_TEST(a_rule_for_one_joint_goes_before_one_for_all);
  RUN_TEST(a_name_may_have_a_colon);
  RUN_TEST(units_are_those_of_the_standards);
  RUN_TEST(an_offset_is_added_in_the_unit_after_the_factor);
  RUN_TEST(stamps_since_an_epoch_count_from_the_first_row);
  RUN_TEST(missing_cells_stay_missing);
  RUN_TEST(what_is_no_number_is_refused_with_its_place);
  RUN_TEST(a_separator_of_thousands_is_refused);
  RUN_TEST(rows_that_do_not_fit_the_names_are_refused);
  RUN_TEST(rules_that_cannot_be_followed_are_refused);
  RUN_TEST(units_that_do_not_fit_are_refused);
  RUN_TEST(what_is_no_recording_is_refused_with_its_line);
  return UNITY_END();
}
