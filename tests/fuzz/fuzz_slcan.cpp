// Text of any kind from a serial line. A frame that is read comes back as it is when written and
// read again, and after whatever came the next whole line is understood.
//
// Input: the bytes.
#include "byte_source.hpp"
#include "messages/slcan.hpp"

using namespace flexcomp;
using flexcomp::fuzz::expect;

namespace {

SlcanReader::Event read(SlcanReader* reader, const SlcanLine& line) {
  SlcanReader::Event event = SlcanReader::Event::nothing;
  for (std::size_t i = 0; i < line.size; ++i) {
    event = reader->take(static_cast<std::uint8_t>(line.text[i]));
  }
  return event;
}

void check_second_journey(const CanFrame& frame) {
  SlcanReader reader;
  expect(read(&reader, to_slcan(frame)) == SlcanReader::Event::frame,
         "what was read can be written");
  const CanFrame& again = reader.frame();
  expect(again.id == frame.id && again.size == frame.size && again.data == frame.data,
         "and is then the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SlcanReader reader;
  for (std::size_t i = 0; i < size; ++i) {
    if (reader.take(data[i]) == SlcanReader::Event::frame) {
      check_second_journey(reader.frame());
    }
  }
  reader.take('\r');
  CanFrame frame;
  frame.id = 0x123;
  frame.size = 2;
  frame.data[0] = 0xAB;
  expect(read(&reader, to_slcan(frame)) == SlcanReader::Event::frame,
         "the next line is understood");
  return 0;
}
