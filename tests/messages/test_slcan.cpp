#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "messages/slcan.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using Event = SlcanReader::Event;

namespace {

std::string text_of(const SlcanLine& line) { return {line.text.data(), line.size}; }

/// Result of the last byte of `text`.
Event read(SlcanReader* reader, const std::string& text) {
  Event event = Event::nothing;
  for (const char c : text) {
    event = reader->take(static_cast<std::uint8_t>(c));
  }
  return event;
}

CanFrame frame(std::uint32_t id, const std::vector<std::uint8_t>& data) {
  CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

void a_frame_is_written_as_the_adapters_manual_shows() {
  TEST_ASSERT_EQUAL_STRING("t10021133\r", text_of(to_slcan(frame(0x100, {0x11, 0x33}))).c_str());
  TEST_ASSERT_EQUAL_STRING("t0200\r", text_of(to_slcan(frame(0x020, {}))).c_str());
  TEST_ASSERT_EQUAL_STRING(
      "t7FF8001122AABBCCDDFF\r",
      text_of(to_slcan(frame(0x7FF, {0x00, 0x11, 0x22, 0xAA, 0xBB, 0xCC, 0xDD, 0xFF}))).c_str());
}

void there_is_no_word_for_an_fd_frame() {
  CanFrame fd = frame(0x120, {1, 2, 3});
  fd.fd = true;
  TEST_ASSERT_EQUAL(0, to_slcan(fd).size);
}

void a_frame_is_read_in_either_case_of_digits() {
  for (const char* text : {"t5A33aBc012\r", "t5a33ABC012\r"}) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL(Event::frame, read(&reader, text));
    TEST_ASSERT_EQUAL_HEX32(0x5A3, reader.frame().id);
    TEST_ASSERT_EQUAL(3, reader.frame().size);
    const std::uint8_t expected[] = {0xAB, 0xC0, 0x12};
    TEST_ASSERT_EQUAL_MEMORY(expected, reader.frame().data.data(), 3);
  }
}

void every_frame_comes_back_as_it_went() {
  std::mt19937 random(1);
  SlcanReader reader;
  for (int i = 0; i < 2000; ++i) {
    CanFrame sent;
    sent.id = random() & 0x7FFU;
    sent.size = static_cast<std::uint8_t>(random() % 9);
    for (std::size_t k = 0; k < sent.size; ++k) {
      sent.data[k] = static_cast<std::uint8_t>(random());
    }
    TEST_ASSERT_EQUAL(Event::frame, read(&reader, text_of(to_slcan(sent))));
    TEST_ASSERT_EQUAL(sent.id, reader.frame().id);
    TEST_ASSERT_EQUAL(sent.size, reader.frame().size);
    TEST_ASSERT_EQUAL_MEMORY(sent.data.data(), reader.frame().data.data(), sent.data.size());
  }
}

void what_is_not_quite_a_frame_is_corrupt() {
  for (const char* text :
       {"t\r", "t10\r", "t100\r", "t1001\r", "t10011\r", "t1001123\r", "t10g0\r", "t8000\r",
        "t1009000000000000000000\r", "t100111223344\r", "t1001 1\r"}) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL_MESSAGE(Event::corrupt, read(&reader, text), text);
  }
}

void other_kinds_of_frames_are_told_from_ours() {
  for (const char* text : {"T0000010021133\r", "r1000\r", "R000001000\r"}) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL_MESSAGE(Event::foreign, read(&reader, text), text);
  }
}

void commands_to_the_adapter_are_known() {
  for (const char* text : {"O\r", "C\r", "S6\r", "V\r", "N\r", "F\r", "\nO\r"}) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL_MESSAGE(Event::command, read(&reader, text), text);
  }
  SlcanReader reader;
  TEST_ASSERT_EQUAL(Event::unknown, read(&reader, "hello\r"));
  TEST_ASSERT_EQUAL(Event::nothing, read(&reader, "\r"));
}

void after_any_rubbish_the_next_whole_line_is_understood() {
  std::mt19937 random(2);
  for (int round = 0; round < 300; ++round) {
    SlcanReader reader;
    for (int i = 0; i < 200; ++i) {
      reader.take(static_cast<std::uint8_t>(random()));
    }
    reader.take('\r');
    TEST_ASSERT_EQUAL(Event::frame, read(&reader, "t10021133\r"));
  }
}

void a_line_without_end_does_no_harm() {
  SlcanReader reader;
  for (int i = 0; i < 100000; ++i) {
    TEST_ASSERT_EQUAL(Event::nothing, reader.take('t'));
  }
  TEST_ASSERT_EQUAL(Event::corrupt, reader.take('\r'));
  TEST_ASSERT_EQUAL(Event::frame, read(&reader, "t0200\r"));
}

/// A line taken at once, or else byte by byte, is the same as byte by byte.
void check_line(const std::string& line) {
  SlcanReader by_byte;
  const Event event = read(&by_byte, line);
  SlcanReader at_once;
  const std::size_t taken =
      at_once.take_frame(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
  TEST_ASSERT_EQUAL(event, taken > 0 ? Event::frame : read(&at_once, line));
  TEST_ASSERT_TRUE(taken == 0 || taken == line.size());
  if (event == Event::frame) {
    TEST_ASSERT_EQUAL_HEX32(by_byte.frame().id, at_once.frame().id);
    TEST_ASSERT_EQUAL(by_byte.frame().size, at_once.frame().size);
    TEST_ASSERT_TRUE(by_byte.frame().data == at_once.frame().data);
  }
}

void a_line_that_is_there_as_a_whole_is_taken_at_once_and_as_the_same() {
  for (const std::string whole : {"t0200\r", "t10021133\r", "t7FF8001122AABBCCDDFF\r"}) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL(
        whole.size(),
        reader.take_frame(reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()));
    for (std::size_t place = 0; place < whole.size(); ++place) {
      for (int byte = 0; byte < 256; ++byte) {
        std::string line = whole;
        line[place] = static_cast<char>(byte);
        if (line.find_first_of("\r\a\n") >= line.size() - 1) {  // one line, ended or not
          check_line(line);
        }
      }
    }
  }
}

void nothing_is_taken_at_once_that_is_not_there_as_a_whole() {
  const std::string line = "t7FF8001122AABBCCDDFF\r";
  const auto* text = reinterpret_cast<const std::uint8_t*>(line.data());
  for (std::size_t there = 0; there < line.size(); ++there) {
    SlcanReader reader;
    TEST_ASSERT_EQUAL(0, reader.take_frame(text, there));
  }
  SlcanReader amidst;
  amidst.take('x');
  TEST_ASSERT_EQUAL(0, amidst.take_frame(text, line.size()));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_frame_is_written_as_the_adapters_manual_shows);
  RUN_TEST(there_is_no_word_for_an_fd_frame);
  RUN_TEST(a_frame_is_read_in_either_case_of_digits);
  RUN_TEST(every_frame_comes_back_as_it_went);
  RUN_TEST(what_is_not_quite_a_frame_is_corrupt);
  RUN_TEST(other_kinds_of_frames_are_told_from_ours);
  RUN_TEST(commands_to_the_adapter_are_known);
  RUN_TEST(after_any_rubbish_the_next_whole_line_is_understood);
  RUN_TEST(a_line_without_end_does_no_harm);
  RUN_TEST(a_line_that_is_there_as_a_whole_is_taken_at_once_and_as_the_same);
  RUN_TEST(nothing_is_taken_at_once_that_is_not_there_as_a_whole);
  return UNITY_END();
}
