#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

#include "linux/background.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using std::chrono::milliseconds;

namespace {

/// A job that lasts until it is let go.
class Stall {
 public:
  std::function<void()> job() const {
    return [gate = gate_.get_future().share()] { gate.wait(); };
  }
  void let_go() { gate_.set_value(); }

 private:
  mutable std::promise<void> gate_;
};

void jobs_are_done_in_order_also_after_one_that_fails() {
  Background background;
  auto done = std::make_shared<std::vector<int>>();
  for (int i = 0; i < 5; ++i) {
    TEST_ASSERT_TRUE(background.start([=] {
      done->push_back(i);
      if (i == 2) {
        throw std::runtime_error("expected here");
      }
    }));
  }
  TEST_ASSERT_TRUE(background.finish(milliseconds(5000)));
  TEST_ASSERT_EQUAL(5, done->size());
  for (int i = 0; i < 5; ++i) {
    TEST_ASSERT_EQUAL(i, (*done)[static_cast<std::size_t>(i)]);
  }
}

void a_job_that_does_not_end_keeps_nobody_waiting_and_no_more_than_so_many_others() {
  Stall stall;
  auto done = std::make_shared<std::atomic<int>>(0);
  {
    Background background;
    TEST_ASSERT_TRUE(background.start(stall.job()));
    int taken = 0;
    while (background.start([=] { ++*done; })) {
      TEST_ASSERT_LESS_THAN(1000, ++taken);
    }
    TEST_ASSERT_FALSE(background.finish(milliseconds(20)));
    stall.let_go();
    TEST_ASSERT_TRUE(background.finish(milliseconds(5000)));
    TEST_ASSERT_EQUAL(taken, *done);
  }
  Stall for_ever;
  {
    Background background;
    TEST_ASSERT_TRUE(background.start(for_ever.job()));
    TEST_ASSERT_FALSE(background.finish(milliseconds(20)));
  }
  for_ever.let_go();  // its thread may end now
}

/// Standard error is a pipe that is full, and that nobody reads.
void who_says_something_does_not_wait_for_a_reader() {
  int ends[2];
  TEST_ASSERT_EQUAL(0, pipe(ends));
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  while (write(ends[1], "xxxx", 4) > 0) {
  }
  fcntl(ends[1], F_SETFL, 0);
  const int before = dup(STDERR_FILENO);
  dup2(ends[1], STDERR_FILENO);
  alarm(10);  // ends the test where it waits
  say_at_once("lost");
  Background background;
  TEST_ASSERT_TRUE(background.say("told when there is room"));
  TEST_ASSERT_FALSE(background.finish(milliseconds(20)));
  std::string text(1 << 20, '\0');
  while (!background.finish(milliseconds(20))) {
    TEST_ASSERT_GREATER_THAN(0, read(ends[0], text.data(), text.size()));
  }
  alarm(0);
  dup2(before, STDERR_FILENO);
  for (const int descriptor : {before, ends[0], ends[1]}) {
    close(descriptor);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(jobs_are_done_in_order_also_after_one_that_fails);
  RUN_TEST(a_job_that_does_not_end_keeps_nobody_waiting_and_no_more_than_so_many_others);
  RUN_TEST(who_says_something_does_not_wait_for_a_reader);
  return UNITY_END();
}
