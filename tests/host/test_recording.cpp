#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>

#include "error.hpp"
#include "host/scratch_folder.hpp"
#include "recording/recording.hpp"
#include "unity_main.hpp"

using flexcomp::InputError;
using flexcomp::recording::read_recording;
using flexcomp::recording::Recording;
using flexcomp::recording::Samples;
using flexcomp::recording::write_recording;
using flexcomp::test::content_of;
using flexcomp::test::put;
using flexcomp::test::ScratchFolder;

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Recording read_text(const std::string& text) {
  const ScratchFolder folder;
  put(folder / "a.csv", text);
  return read_recording(folder / "a.csv");
}

/// Complaint about a file with this content, after the file's name.
std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  put(folder / "a.csv", text);
  try {
    read_recording(folder / "a.csv");
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string file = (folder / "a.csv").string();
    return message.substr(0, file.size()) == file ? message.substr(file.size()) : message;
  }
  return "accepted";
}

void expect_refusal(const char* reason, const std::string& text) {
  TEST_ASSERT_EQUAL_STRING(reason, refusal(text).c_str());
}

std::array<std::optional<Samples> Recording::*, 7> groups() {
  return {&Recording::q_cmd,  &Recording::q_meas,   &Recording::q_link,     &Recording::tau,
          &Recording::wrench, &Recording::position, &Recording::temperature};
}

bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

bool same(const Samples& a, const Samples& b) {
  bool equal = a.rows() == b.rows() && a.cols() == b.cols();
  for (Eigen::Index i = 0; equal && i < a.size(); ++i) {
    equal = same_bits(a.data()[i], b.data()[i]);
  }
  return equal;
}

bool same(const Recording& a, const Recording& b) {
  bool equal = same(Samples(a.time), Samples(b.time));
  for (const auto group : groups()) {
    equal = equal && (a.*group).has_value() == (b.*group).has_value() &&
            (!(a.*group) || same(*(a.*group), *(b.*group)));
  }
  return equal;
}

/// Any finite double, of any magnitude, or a missing sample.
double random_sample(std::mt19937_64* random) {
  if ((*random)() % 8 == 0) {
    return kMissing;
  }
  double value = kMissing;
  while (!(std::abs(value) <= 1e30)) {
    const std::uint64_t bits = (*random)();
    std::memcpy(&value, &bits, sizeof value);
  }
  return value;
}

Recording random_recording(std::mt19937_64* random) {
  Recording recording;
  const auto rows = static_cast<Eigen::Index>(1 + (*random)() % 20);
  recording.time.resize(rows);
  double t = -1;
  for (Eigen::Index row = 0; row < rows; ++row) {
    t += std::uniform_real_distribution<double>(1e-9, 1)(*random);
    recording.time[row] = t;
  }
  for (const auto group : groups()) {
    if ((*random)() % 2 == 0) {
      const int columns = group == &Recording::position      ? 3
                          : group == &Recording::temperature ? 1
                                                             : 6;
      recording.*group =
          Samples::NullaryExpr(rows, columns, [random] { return random_sample(random); });
    }
  }
  return recording;
}

void columns_may_stand_in_any_order() {
  const Recording recording = read_text("z,t,x,temp_c,y\n3,0,1,20,2\n6,0.5,4,21,5\n");
  TEST_ASSERT_EQUAL(2, recording.size());
  TEST_ASSERT_EQUAL_DOUBLE(0.5, recording.time[1]);
  TEST_ASSERT_TRUE(same(*recording.position, (Samples(2, 3) << 1, 2, 3, 4, 5, 6).finished()));
  TEST_ASSERT_EQUAL_DOUBLE(21, (*recording.temperature)(1, 0));
  TEST_ASSERT_FALSE(recording.q_cmd || recording.q_meas || recording.q_link || recording.tau ||
                    recording.wrench);
}

void empty_cells_are_missing_not_zero() {
  const Recording recording = read_text("t,x,y,z\n0,1,,3\n1,,,\n");
  TEST_ASSERT_TRUE(
      same(*recording.position,
           (Samples(2, 3) << 1, kMissing, 3, kMissing, kMissing, kMissing).finished()));
}

void byte_order_mark_crlf_and_blank_lines_make_no_difference() {
  const Recording plain = read_text("t,x,y,z\n0,1,2,3\n1,4,5,6\n");
  TEST_ASSERT_TRUE(same(plain, read_text("\xEF\xBB\xBFt, x,y ,z\r\n0,1,2,3\r\n1,4, 5,6\r\n\r\n")));
  TEST_ASSERT_TRUE(same(plain, read_text("t,x,y,z\n0,1,2,3\n1,4,5,6")));
}

void numbers_mean_what_the_c_library_says() {
  for (const char* text :
       {"0.1", "-0", "1e-3", "1E5", "5e-324", "9.9999999999999997e29", "2.2250738585072011e-308",
        "0.30000000000000004", "123456789012345678"}) {
    const Recording recording = read_text("t,temp_c\n0," + std::string(text) + "\n");
    TEST_ASSERT_TRUE(same_bits(std::strtod(text, nullptr), (*recording.temperature)(0, 0)));
  }
}

void messages_point_to_the_line_of_a_row() {
  const Recording recording = read_text("t\n\n0\n\n1\n");
  TEST_ASSERT_EQUAL_STRING((recording.file + ":5").c_str(), recording.place(1).c_str());
}

void cells_that_are_no_finite_number_are_refused() {
  const std::string header = "t,tau_1,tau_2,tau_3,tau_4,tau_5,tau_6\n0,1,2,3,4,5,6\n";
  expect_refusal(":3: column 'tau_3': 'abc' is not a finite number", header + "1,1,2,abc,4,5,6\n");
  expect_refusal(
      ":3: column 'tau_1': '-2e30' is larger than any measurement; expected at most 1e+30",
      header + "1,-2e30,2,3,4,5,6\n");
  for (const char* cell : {"inf", "-inf", "nan", "NaN", "1e999", "0x10", "+1", "1.5.2", "1e", "1 2",
                           "\"1\"", "--1", "1f", "-", "."}) {
    const std::string reason = std::string(":3: column 't': '") + cell + "' is not a finite number";
    expect_refusal(reason.c_str(), header + cell + ",1,2,3,4,5,6\n");
  }
}

void other_separators_are_named() {
  expect_refusal(
      ":1: semicolons separate the columns, not commas; flexcomp convert makes a recording of it",
      "t;x;y;z\n0;1;2;3\n");
  expect_refusal(
      ":1: tabs separate the columns, not commas; flexcomp convert makes a recording of it",
      "t\tx\ty\tz\n0\t1\t2\t3\n");
}

void a_decimal_comma_is_a_wrong_column_count() {
  expect_refusal(":2: expected 2 cells as in the header, found 3", "t,temp_c\n0,20,5\n");
}

void rows_with_too_few_cells_are_refused() {
  expect_refusal(":3: expected 4 cells as in the header, found 3", "t,x,y,z\n0,1,2,3\n1,2,3\n");
}

void unknown_columns_are_refused() {
  expect_refusal(
      ":1: column 'speed' is unknown; expected t, q_cmd_1..6, q_meas_1..6, q_link_1..6, tau_1..6, "
      "fx..mz, x,y,z, temp_c or line",
      "t,speed\n0,1\n");
}

void repeated_and_unnamed_columns_are_refused() {
  expect_refusal(":1: column 'x' appears twice", "t,x,y,z,x\n0,1,2,3,4\n");
  expect_refusal(":1: column 3 has no name", "t,x,,z\n0,1,2,3\n");
}

void a_group_that_is_there_in_part_is_refused() {
  expect_refusal(":1: column 'mz' is missing; fx to mz belong together",
                 "t,fx,fy,fz,mx,my\n0,1,2,3,4,5\n");
}

void time_has_to_be_there_and_increase() {
  expect_refusal(":1: column 't' is missing", "x,y,z\n1,2,3\n");
  expect_refusal(":3: column 't': a time is missing", "t,x,y,z\n0,1,2,3\n,1,2,3\n");
  expect_refusal(":4: column 't': time must increase, found 0.5 after 1", "t\n0\n1\n0.5\n");
  expect_refusal(":3: column 't': time must increase, found 1 after 1", "t\n1\n1\n");
}

void files_without_rows_are_refused() {
  expect_refusal(": the file is empty", "");
  expect_refusal(": the file is blank", "\n\n \r\n");
  expect_refusal(": no rows below the header", "t,x,y,z\n");
  expect_refusal(":1: the line is blank; expected the columns' names", "\nt,x,y,z\n0,1,2,3\n");
}

void files_that_are_no_text_are_refused() {
  expect_refusal(": not a text file", std::string("t\n0\n\0\n", 6));
  TEST_ASSERT_NOT_NULL(
      std::strstr(refusal("t,\x1b[31mx\x80\n0,1\n").c_str(), "'?[31mx?' is unknown"));
}

void huge_lines_are_refused() {
  expect_refusal(":1: the line has 100000 characters; expected at most 65536",
                 std::string(100000, ','));
  expect_refusal(":2: the line has 70000 characters; expected at most 65536",
                 "t\n" + std::string(70000, '1'));
}

void a_recording_survives_writing_and_reading() {
  const ScratchFolder folder;
  std::mt19937_64 random(20170101);
  for (int round = 0; round < 200; ++round) {
    const Recording recording = random_recording(&random);
    write_recording(folder / "a.csv", recording);
    TEST_ASSERT_TRUE(same(recording, read_recording(folder / "a.csv")));
  }
  TEST_ASSERT_EQUAL(1, folder.file_count());
}

void numbers_are_written_in_their_shortest_form() {
  const ScratchFolder folder;
  Recording recording;
  recording.time = Eigen::Vector2d(0, 0.1);
  recording.position = (Samples(2, 3) << 1, -2.5, 0.1 + 0.2, kMissing, 1e-7, 3).finished();
  write_recording(folder / "a.csv", recording);
  TEST_ASSERT_EQUAL_STRING("t,x,y,z\n0,1,-2.5,0.30000000000000004\n0.1,,1e-07,3\n",
                           content_of(folder / "a.csv").c_str());
}

void a_full_disk_is_one_clear_error() {
  std::string message;
  try {
    write_recording("/dev/full", read_text("t\n0\n"));
  } catch (const InputError& error) {
    message = error.what();
  }
  TEST_ASSERT_EQUAL_STRING("/dev/full: cannot be written: No space left on device",
                           message.c_str());
}

/// True if writing is refused as a fault of the caller, before there is a file.
bool is_refused_as_a_fault(const Recording& recording) {
  const ScratchFolder folder;
  try {
    write_recording(folder / "a.csv", recording);
  } catch (const std::invalid_argument&) {
    return folder.file_count() == 0;
  }
  return false;
}

void a_recording_that_could_not_be_read_back_is_not_written() {
  const Recording good = read_text("t,x,y,z\n0,1,2,3\n1,4,5,6\n");
  TEST_ASSERT_FALSE(is_refused_as_a_fault(good));
  TEST_ASSERT_TRUE(is_refused_as_a_fault(Recording{}));
  Recording bad = good;
  bad.time[1] = 0;
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
  bad.time[1] = kMissing;
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
  bad = good;
  bad.position->conservativeResize(1, 3);
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
  bad.position->setZero(2, 6);
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
  bad = good;
  (*bad.position)(1, 2) = std::numeric_limits<double>::infinity();
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
  (*bad.position)(1, 2) = -2e30;
  TEST_ASSERT_TRUE(is_refused_as_a_fault(bad));
}

const std::string& sample_text() {
  static const std::string kText =
      "t,q_cmd_1,q_cmd_2,q_cmd_3,q_cmd_4,q_cmd_5,q_cmd_6,x,y,z\r\n"
      "0,0.1,-1.5e-3,2,3,4,5,1.25,,-0.75\r\n"
      "0.004,0.1,-1.5e-3,2,3,4,5,1.25,0.5,-0.75\r\n";
  return kText;
}

void a_cut_off_file_is_read_or_refused_with_its_name() {
  int accepted = 0;
  for (std::size_t length = 0; length <= sample_text().size(); ++length) {
    const std::string verdict = refusal(sample_text().substr(0, length));
    accepted += verdict == "accepted" ? 1 : 0;
    TEST_ASSERT_TRUE(verdict == "accepted" || verdict.front() == ':');
  }
  TEST_ASSERT_TRUE(accepted > 2 && accepted < 20);
}

void a_garbled_file_is_read_or_refused_with_its_name() {
  std::mt19937 random(7);
  for (int round = 0; round < 3000; ++round) {
    std::string text = sample_text();
    for (unsigned change = 0; change < 1 + random() % 6; ++change) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    const std::string verdict = refusal(text);
    TEST_ASSERT_TRUE(verdict == "accepted" || verdict.front() == ':');
    TEST_ASSERT_TRUE(verdict.find('\n') == std::string::npos);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(columns_may_stand_in_any_order);
  RUN_TEST(empty_cells_are_missing_not_zero);
  RUN_TEST(byte_order_mark_crlf_and_blank_lines_make_no_difference);
  RUN_TEST(numbers_mean_what_the_c_library_says);
  RUN_TEST(messages_point_to_the_line_of_a_row);
  RUN_TEST(cells_that_are_no_finite_number_are_refused);
  RUN_TEST(other_separators_are_named);
  RUN_TEST(a_decimal_comma_is_a_wrong_column_count);
  RUN_TEST(rows_with_too_few_cells_are_refused);
  RUN_TEST(unknown_columns_are_refused);
  RUN_TEST(repeated_and_unnamed_columns_are_refused);
  RUN_TEST(a_group_that_is_there_in_part_is_refused);
  RUN_TEST(time_has_to_be_there_and_increase);
  RUN_TEST(files_without_rows_are_refused);
  RUN_TEST(files_that_are_no_text_are_refused);
  RUN_TEST(huge_lines_are_refused);
  RUN_TEST(a_recording_survives_writing_and_reading);
  RUN_TEST(numbers_are_written_in_their_shortest_form);
  RUN_TEST(a_full_disk_is_one_clear_error);
  RUN_TEST(a_recording_that_could_not_be_read_back_is_not_written);
  RUN_TEST(a_cut_off_file_is_read_or_refused_with_its_name);
  RUN_TEST(a_garbled_file_is_read_or_refused_with_its_name);
  return UNITY_END();
}
