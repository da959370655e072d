// Frames of any kind into the decoder. What it lets through must survive a second journey: encoded
// and decoded again it is the same frames, so nothing that was accepted is ambiguous.
//
// Input: a byte of flags a frame (1 FD, 2 with a valid checksum, 4 and 8 milliseconds since the one
// before), the identifier (2 bytes), the size (1) and so many bytes of data.
#include "byte_source.hpp"
#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "messages/e2e.hpp"

using namespace flexcomp;
using flexcomp::fuzz::ByteSource;
using flexcomp::fuzz::expect;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

bool is_same(const FrameList& a, const FrameList& b) {
  bool same = a.count == b.count;
  for (std::size_t i = 0; same && i < a.count; ++i) {
    same = a.frames[i].id == b.frames[i].id && a.frames[i].size == b.frames[i].size &&
           a.frames[i].data == b.frames[i].data;
  }
  return same;
}

void check_second_journey(const Message& message, bool fd) {
  const FrameList frames = CanEncoder(fd).encode(message);
  CanDecoder decoder;
  Message again;
  for (std::size_t i = 0; i < frames.count; ++i) {
    again = decoder.decode(frames.frames[i], 0);
  }
  // A data message with more words than a frame has is for the receiver to refuse.
  expect(frames.count == 0 || is_same(frames, CanEncoder(fd).encode(again)),
         "what was decoded encodes to the same frames");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  CanDecoder decoder;
  std::int64_t now = 0;
  while (!bytes.is_empty()) {
    const auto flags = bytes.take<std::uint8_t>();
    CanFrame frame;
    frame.fd = (flags & 1U) != 0;
    frame.id = bytes.take<std::uint16_t>();
    frame.size = bytes.take<std::uint8_t>();
    bytes.take_into(frame.data.data(), std::min<std::size_t>(frame.size, frame.data.size()));
    if ((flags & 2U) != 0 && frame.size <= frame.data.size()) {
      protect(&frame);
    }
    now += kMillisecond * (flags & 12U) * 5;
    const Message message = decoder.decode(frame, now);
    if (message.index() != 0) {
      expect(is_intact(frame), "no message from a damaged frame");
      check_second_journey(message, frame.fd);
    }
  }
  return 0;
}
