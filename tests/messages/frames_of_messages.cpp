// Prints the frames of one message of every kind, classic and FD, for test_frames.py: a line each
// of `classic` or `fd` (what the encoder was told), identifier, `1` for an FD frame and the payload
// in hexadecimal.
#include <cstdio>

#include "messages/can_encoder.hpp"
#include "one_of_each.hpp"

using namespace flexcomp;

namespace {

void print(const char* format, const CanFrame& frame) {
  std::printf("%s %u %d ", format, static_cast<unsigned>(frame.id), frame.fd ? 1 : 0);
  for (std::size_t i = 0; i < frame.size; ++i) {
    std::printf("%02x", frame.data[i]);
  }
  std::printf("\n");
}

}  // namespace

int main() {
  for (const bool fd : {false, true}) {
    CanEncoder encoder(fd);
    for (int round = 0; round < 2; ++round) {
      for (const Message& message : test::one_of_each()) {
        const FrameList& list = encoder.encode(message);
        for (std::size_t i = 0; i < list.count; ++i) {
          print(fd ? "fd" : "classic", list.frames[i]);
        }
      }
    }
  }
  return 0;
}
