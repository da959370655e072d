#include <deque>
#include <random>
#include <vector>

#include "node/ring.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr std::size_t kSize = 16;

/// Pushed and popped one by one and in rows, in any order, against a queue without end.
void what_goes_in_comes_out_in_order() {
  Ring<int, kSize> ring;
  std::deque<int> expected;
  std::mt19937 random(1);
  int next = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<int> items(random() % (kSize + 3));
    for (int& item : items) {
      item = next++;
    }
    const bool fits = items.size() <= kSize - expected.size();
    TEST_ASSERT_EQUAL(kSize - expected.size(), ring.room());
    switch (random() % 4) {
      case 0:
        TEST_ASSERT_EQUAL(fits, ring.push_all(items.data(), items.size()));
        expected.insert(expected.end(), items.begin(), fits ? items.end() : items.begin());
        break;
      case 1:
        TEST_ASSERT_EQUAL(expected.size() < kSize, ring.push(next));
        expected.insert(expected.end(), expected.size() < kSize ? 1 : 0, next);
        break;
      case 2: {
        std::size_t count = 0;
        const int* const front = ring.front(&count);
        TEST_ASSERT_EQUAL(expected.empty(), count == 0);
        for (std::size_t k = 0; k < count; ++k) {
          TEST_ASSERT_EQUAL(expected[k], front[k]);
        }
        const std::size_t taken = count == 0 ? 0 : random() % (count + 1);
        ring.drop(taken);
        expected.erase(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(taken));
        break;
      }
      default: {
        int item = 0;
        TEST_ASSERT_EQUAL(!expected.empty(), ring.pop(&item));
        if (!expected.empty()) {
          TEST_ASSERT_EQUAL(expected.front(), item);
          expected.pop_front();
        }
        break;
      }
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_goes_in_comes_out_in_order);
  return UNITY_END();
}
