#include "linux/lcm_link.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

/// LCM's transport within a process, which brings back all that a link publishes, as multicast
/// does.
constexpr const char* kLoop = "memq://";

/// Whether it is read at once or only after a stall.
void what_a_link_publishes_does_not_come_back_to_it_however_late() {
  int handed_over = 0;
  LcmLink link(kLoop, [&](const LcmMessage&) { ++handed_over; });
  constexpr int kStall = 1000;
  for (int i = 0; i < kStall; ++i) {
    TEST_ASSERT_TRUE(link.publish(CorrectedMessage{}));
    TEST_ASSERT_TRUE(link.publish(HeartbeatMessage{}));
  }
  for (int i = 0; i < 2 * kStall; ++i) {
    link.handle();
  }
  TEST_ASSERT_EQUAL(0, handed_over);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_a_link_publishes_does_not_come_back_to_it_however_late);
  return UNITY_END();
}
