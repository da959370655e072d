// Logs of buses: reading, writing, and putting the clocks of two of them together.
#include <cmath>
#include <functional>

#include "error.hpp"
#include "host/scratch_folder.hpp"
#include "recording/clock_alignment.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::recording;
using flexcomp::test::content_of;
using flexcomp::test::put;
using flexcomp::test::ScratchFolder;

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

Recording made_recording() {
  constexpr Eigen::Index kRows = 50;
  Recording recording;
  recording.file = "made";
  recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, 0.196);
  recording.q_cmd = Samples(kRows, 6);
  recording.q_meas = Samples(kRows, 6);
  recording.wrench = Samples(kRows, 6);
  recording.position = Samples(kRows, 3);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    for (Eigen::Index k = 0; k < 6; ++k) {
      (*recording.q_cmd)(i, k) = 1e-6 * static_cast<double>((17 * i + 1000 * k) % 4001);
      (*recording.q_meas)(i, k) = (*recording.q_cmd)(i, k) + 2e-6;
      (*recording.wrench)(i, k) = static_cast<double>(i + 10 * k);
    }
    recording.position->row(i) << 1.6, -0.1, 0.001 * static_cast<double>(i);
  }
  recording.position->row(7).setConstant(NAN);
  return recording;
}

void assert_same(const Samples& expected, const Samples& actual, double tolerance) {
  TEST_ASSERT_EQUAL(expected.rows(), actual.rows());
  TEST_ASSERT_EQUAL(expected.cols(), actual.cols());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const double wanted = expected.data()[i];
    const double found = actual.data()[i];
    TEST_ASSERT_EQUAL(std::isnan(wanted), std::isnan(found));
    TEST_ASSERT_TRUE(std::isnan(wanted) || std::fabs(wanted - found) <= tolerance);
  }
}

void a_recording_goes_through_a_log_and_back() {
  const ScratchFolder folder;
  const Recording made = made_recording();
  const auto messages = to_messages(made, kStart);
  DecodingCounts counts;
  write_candump_log(folder / "a.log", encode_frames(messages, "can0", false));
  write_candump_log(folder / "b.log", encode_frames(messages, "can0", true));
  write_lcm_log(folder / "c.lcmlog", encode_events(messages));
  for (const Recording& back :
       {to_recording(decode(read_candump_log(folder / "a.log"), &counts), false, "a"),
        to_recording(decode(read_candump_log(folder / "b.log"), &counts), false, "b"),
        to_recording(decode(read_lcm_log(folder / "c.lcmlog"), &counts), false, "c")}) {
    TEST_ASSERT_TRUE((back.time - made.time).cwiseAbs().maxCoeff() < 2e-6);
    assert_same(*made.q_cmd, *back.q_cmd, 1.1e-7);
    assert_same(*made.q_meas, *back.q_meas, 1.1e-7);
    assert_same(*made.wrench, *back.wrench, 1e-9);
    assert_same(*made.position, *back.position, 1.1e-7);
  }
  TEST_ASSERT_EQUAL(0, counts.rejected);
  TEST_ASSERT_EQUAL(0, counts.foreign);
}

void a_candump_line_is_read_as_candump_means_it() {
  const ScratchFolder folder;
  put(folder / "a.log",
      "(1436509052.249713) vcan0 044#2A366C2BBA\n"
      "\n"
      "(1436509052.25) can1 123##1AABB R\n"
      "(1436509053.000001) can1 7FF#\r\n"
      "(1436509054.0) can1 12345678#00\n"
      "(1436509054.5) can1 20000040#0000000000000000\n"
      "(1436509055.0) can1 123#R8\n");
  const auto frames = read_candump_log(folder / "a.log");
  TEST_ASSERT_EQUAL(3, frames.size());
  TEST_ASSERT_EQUAL_INT64(1436509052249713000, frames[0].time);
  TEST_ASSERT_EQUAL_STRING("vcan0", frames[0].interface.c_str());
  TEST_ASSERT_EQUAL_HEX32(0x44, frames[0].frame.id);
  TEST_ASSERT_EQUAL(5, frames[0].frame.size);
  TEST_ASSERT_EQUAL_HEX8(0xBA, frames[0].frame.data[4]);
  TEST_ASSERT_TRUE(frames[1].frame.fd);
  TEST_ASSERT_EQUAL(2, frames[1].frame.size);
  TEST_ASSERT_EQUAL_INT64(1436509052250000000, frames[1].time);
  TEST_ASSERT_EQUAL(0, frames[2].frame.size);
}

/// The complaint that reading gives; empty if it gives none.
std::string complaint(const std::function<void()>& read) {
  try {
    read();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void a_line_that_makes_no_sense_is_refused_by_its_number() {
  const ScratchFolder folder;
  for (const char* bad :
       {"hello", "(1.0) can0", "(x.0) can0 123#00", "(1) can0 123#00", "1.0 can0 123#00",
        "(1.0) can0 123#0", "(1.0) can0 123#zz", "(1.0) can0 123#001122334455667788",
        "(1.0) can0 12#00", "(1.0) can0 123##", "(1.0) can0 123#00 R more",
        "(1.1234567891) can0 123#00", "(99999999999999.0) can0 123#00", "(1.0) can0 #00",
        "(1.0) can0 123##x00"}) {
    put(folder / "a.log", std::string("(1.0) can0 123#00\n") + bad + "\n");
    const std::string text = complaint([&] { read_candump_log(folder / "a.log"); });
    TEST_ASSERT_TRUE_MESSAGE(text.find("a.log:2:") != std::string::npos, bad);
  }
}

void a_log_of_endless_interfaces_is_refused() {
  const ScratchFolder folder;
  std::string log;
  for (int i = 0; i < 64; ++i) {
    log += "(1.5) can" + std::to_string(i) + " 100#00\n";
  }
  put(folder / "a.log", log);
  TEST_ASSERT_EQUAL(64, read_candump_log(folder / "a.log").size());
  put(folder / "a.log", log + "(1.5) vcan0 100#00\n");
  const std::string text = complaint([&] { read_candump_log(folder / "a.log"); });
  TEST_ASSERT_TRUE(text.find("a.log:65: expected at most 64 interfaces") != std::string::npos);
}

void a_damaged_or_truncated_event_log_is_refused_by_its_byte() {
  const ScratchFolder folder;
  write_lcm_log(folder / "a.lcmlog", encode_events(to_messages(made_recording(), kStart)));
  const std::string whole = content_of(folder / "a.lcmlog");
  for (const std::size_t size : {std::size_t{10}, std::size_t{40}, whole.size() - 1}) {
    put(folder / "b.lcmlog", whole.substr(0, size));
    const std::string text = complaint([&] { read_lcm_log(folder / "b.lcmlog"); });
    TEST_ASSERT_TRUE(text.find("ends within an event") != std::string::npos);
  }
  std::string damaged = whole;
  damaged[0] = 'x';
  put(folder / "b.lcmlog", damaged);
  const std::string text = complaint([&] { read_lcm_log(folder / "b.lcmlog"); });
  TEST_ASSERT_TRUE(text.find("byte 0: expected an event") != std::string::npos);
  for (const char wrong : {'\x7F', '\x80', '\xFF'}) {  // µs that are too many ns, or negative
    damaged = whole;
    damaged[12] = wrong;
    put(folder / "b.lcmlog", damaged);
    const std::string late = complaint([&] { read_lcm_log(folder / "b.lcmlog"); });
    TEST_ASSERT_TRUE(late.find("byte 0: the time of the event is out of range") !=
                     std::string::npos);
  }
}

/// A robot that moves, its setpoints as another clock sees them.
std::vector<LoggedMessage> moving_log(double begin, double end, double offset, double rate,
                                      double period) {
  std::vector<LoggedMessage> messages;
  for (double t = begin; t < end; t += period) {
    SetpointMessage setpoint;
    for (std::size_t k = 0; k < 6; ++k) {
      const double at = static_cast<double>(k);
      setpoint.q[k] = 0.3 * std::sin((1 + 0.3 * at) * t + at) + 0.01 * t;
    }
    // The second clock shows t₂ where t = t₂ + offset + rate (t₂ − t₂ of its first message).
    const double first = begin - offset;
    const double shown = first + (t - begin) / (1 + rate);
    messages.push_back({kStart + std::llround(1e9 * shown), setpoint});
  }
  return messages;
}

void clocks_are_aligned_by_the_motion_that_both_logs_hold() {
  for (const double offset : {0.0, 3.2, -17.4, 1000.0}) {
    for (const double rate : {0.0, 80e-6}) {
      const auto first = moving_log(0, 20, 0, 0, 0.004);
      const auto second = moving_log(5.001, 26, offset, rate, 0.01);
      const ClockAlignment alignment = align_clocks(first, second);
      TEST_ASSERT_DOUBLE_WITHIN(20e-6, offset, alignment.offset);
      TEST_ASSERT_DOUBLE_WITHIN(2e-6, rate, alignment.rate);
      TEST_ASSERT_TRUE(alignment.uncertainty < 20e-6);
    }
  }
}

void merged_logs_are_in_the_first_ones_time_and_in_order() {
  const auto first = moving_log(0, 10, 0, 0, 0.004);
  const auto second = moving_log(2, 9, 50, 0, 0.01);
  const auto merged = merge(first, second, align_clocks(first, second));
  TEST_ASSERT_EQUAL(first.size() + second.size(), merged.size());
  for (std::size_t i = 1; i < merged.size(); ++i) {
    TEST_ASSERT_TRUE(merged[i - 1].time <= merged[i].time);
  }
  TEST_ASSERT_TRUE(merged.back().time < kStart + 10'100'000'000);
}

void logs_that_cannot_be_aligned_are_refused() {
  const auto moving = moving_log(0, 10, 0, 0, 0.004);
  std::vector<LoggedMessage> standing = moving;
  for (LoggedMessage& logged : standing) {
    logged.message = SetpointMessage{};
  }
  TEST_ASSERT_TRUE(complaint([&] { align_clocks(moving, standing); }).find("does not move") !=
                   std::string::npos);
  TEST_ASSERT_TRUE(complaint([&] { align_clocks(moving, {}); }).find("no setpoints in common") !=
                   std::string::npos);
}

void what_no_message_carries_is_named() {
  Recording recording = made_recording();
  TEST_ASSERT_EQUAL_STRING("", groups_without_message(recording).c_str());
  recording.tau = recording.q_cmd;
  recording.temperature = Samples::Zero(recording.size(), 1);
  TEST_ASSERT_EQUAL_STRING("tau, temp_c", groups_without_message(recording).c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_recording_goes_through_a_log_and_back);
  RUN_TEST(a_candump_line_is_read_as_candump_means_it);
  RUN_TEST(a_line_that_makes_no_sense_is_refused_by_its_number);
  RUN_TEST(a_log_of_endless_interfaces_is_refused);
  RUN_TEST(a_damaged_or_truncated_event_log_is_refused_by_its_byte);
  RUN_TEST(clocks_are_aligned_by_the_motion_that_both_logs_hold);
  RUN_TEST(merged_logs_are_in_the_first_ones_time_and_in_order);
  RUN_TEST(logs_that_cannot_be_aligned_are_refused);
  RUN_TEST(what_no_message_carries_is_named);
  return UNITY_END();
}
