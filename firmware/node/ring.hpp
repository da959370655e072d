#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace flexcomp {

/// Queue from one thread (or interrupt) to one other, without locks. Fixed memory; `Size` is a
/// power of two.
template <typename Item, std::size_t Size>
class Ring {
  static_assert((Size & (Size - 1)) == 0, "a power of two");

 public:
  /// False if it is full; the item is then dropped.
  bool push(const Item& item) {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == Size) {
      return false;
    }
    items_[end % Size] = item;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// All of these items or, where there is no room for them, none.
  bool push_all(const Item* items, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Item>);
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (Size - (end - begin_.load(std::memory_order_acquire)) < count) {
      return false;
    }
    if (count == 0) {
      return true;  // `items` may be null then, which memcpy may not see
    }
    const std::size_t before_wrap = std::min(count, Size - end % Size);
    std::memcpy(&items_[end % Size], items, before_wrap * sizeof(Item));
    std::memcpy(items_.data(), items + before_wrap, (count - before_wrap) * sizeof(Item));
    end_.store(end + count, std::memory_order_release);
    return true;
  }

  /// How many more items fit, as the one that pushes sees it.
  std::size_t room() const {
    return Size - (end_.load(std::memory_order_relaxed) - begin_.load(std::memory_order_acquire));
  }

  /// The oldest items that lie in a row, `count` of them, for the one that pops; they stay until
  /// `drop`. None only if it is empty.
  const Item* front(std::size_t* count) const {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    const std::size_t there = end_.load(std::memory_order_acquire) - begin;
    *count = std::min(there, Size - begin % Size);
    return &items_[begin % Size];
  }
  /// Forgets the oldest items, at most as many as `front` has shown.
  void drop(std::size_t count) {
    begin_.store(begin_.load(std::memory_order_relaxed) + count, std::memory_order_release);
  }

  /// False if it is empty.
  bool pop(Item* item) {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) {
      return false;
    }
    *item = items_[begin % Size];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<Item, Size> items_{};
  alignas(64) std::atomic<std::size_t> begin_{0};
  alignas(64) std::atomic<std::size_t> end_{0};
};

}  // namespace flexcomp
