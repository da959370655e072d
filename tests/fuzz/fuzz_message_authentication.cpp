// Frames of any kind at a receiver with a key that their sender does not have. None of a covered
// message goes on to the decoder, unless so damaged that the decoder refuses it.
//
// Input: a byte of flags a frame (1 FD, 2 with a valid checksum, 4 as long as its layout says, 8 to
// 64 milliseconds since the one before), the identifier (2 bytes), the size (1) and so many bytes
// of data.
#include <algorithm>

#include "byte_source.hpp"
#include "messages/e2e.hpp"
#include "messages/message_authentication.hpp"

using namespace flexcomp;
using flexcomp::fuzz::ByteSource;
using flexcomp::fuzz::expect;

namespace {

Freshness the_time = 0;

Freshness test_clock() { return the_time; }

std::uint8_t size_of(std::uint32_t id, std::uint8_t otherwise) {
  const FrameLayout* part = find_layout(id);
  const AuthenticationLayout* authentication = find_authentication(id);
  return part != nullptr             ? part->size
         : authentication != nullptr ? authentication->size
                                     : otherwise;
}

bool is_covered(std::uint32_t id) {
  const FrameLayout* part = find_layout(id);
  return find_authentication(id) != nullptr ||
         (part != nullptr && find_authentication(part->group) != nullptr);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  the_time = 179'000'000'000'000;
  MessageAuthentication authentication(AuthenticationKey{7, 1, 4}, test_clock);
  while (!bytes.is_empty()) {
    const auto flags = bytes.take<std::uint8_t>();
    CanFrame frame;
    frame.fd = (flags & 1U) != 0;
    frame.id = bytes.take<std::uint16_t>();
    frame.size = bytes.take<std::uint8_t>();
    if ((flags & 4U) != 0) {
      frame.size = size_of(frame.id, frame.size);
    }
    bytes.take_into(frame.data.data(), std::min<std::size_t>(frame.size, frame.data.size()));
    if ((flags & 2U) != 0 && frame.size <= frame.data.size()) {
      protect(&frame);
    }
    the_time += 100U * (flags >> 3);
    const FrameList& admitted = authentication.admit(frame);
    if (!is_covered(frame.id)) {
      expect(admitted.count == 1, "what is not covered goes on");
    } else if (admitted.count > 0) {
      const FrameLayout* part = find_layout(frame.id);
      expect(admitted.count == 1 && part != nullptr, "no message without the key");
      expect(frame.size != part->size || frame.fd != part->fd || !is_intact(frame),
             "no whole frame of a covered message goes on alone");
    }
  }
  return 0;
}
