// Messages under a key, so and so many, for callgrind to count the instructions of.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "messages/can_encoder.hpp"
#include "messages/message_authentication.hpp"

using namespace flexcomp;

namespace {

Freshness the_time = 179'000'000'000'000;

Freshness test_clock() { return the_time; }

/// Steps done with a message; each takes those before it.
enum class Step { encode, seal, admit };

Message message_of(const char* name) {
  if (std::strcmp(name, "setpoint") == 0) {
    return SetpointMessage{0, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}};
  }
  if (std::strcmp(name, "wrench") == 0) {
    return WrenchMessage{0, {1, 2, 3, 4, 5, 6}, false};
  }
  if (std::strcmp(name, "command") == 0) {
    return CommandMessage{Command::report};
  }
  CorrectedMessage corrected;
  corrected.corrected = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  return corrected;
}

Step step_of(const char* name) {
  if (std::strcmp(name, "seal") == 0) {
    return Step::seal;
  }
  return std::strcmp(name, "admit") == 0 ? Step::admit : Step::encode;
}

}  // namespace

/// Arguments: step, message, "fd" or "classic", count. Prints how many messages were taken in.
int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "expected a step, a message, classic or fd, and a count\n");
    return 2;
  }
  const Step step = step_of(argv[1]);
  const Message message = message_of(argv[2]);
  CanEncoder encoder(std::strcmp(argv[3], "fd") == 0);
  const AuthenticationKey key{};
  MessageAuthentication sender(key, test_clock);
  MessageAuthentication receiver(key, test_clock);
  the_time += 2 * kFreshnessWindow;
  std::size_t taken = 0;
  for (int i = 0; i < std::atoi(argv[4]); ++i) {
    the_time += 400;
    const FrameList& frames = encoder.encode(message);
    if (step == Step::encode) {
      continue;
    }
    const SealedFrames& sealed = sender.seal(frames);
    for (std::size_t k = 0; step == Step::admit && k < sealed.count; ++k) {
      taken += receiver.admit(sealed.frames[k]).count > 0 ? 1U : 0U;
    }
  }
  std::printf("%zu\n", taken);
  return 0;
}
