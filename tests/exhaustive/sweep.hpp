#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

namespace flexcomp::exhaustive {

inline float float_of(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Result of a sweep.
struct Tally {
  std::uint64_t tried = 0;
  std::uint64_t wrong = 0;
  std::uint32_t first_wrong = 0;  ///< bits of a float
};

/// Tries every `stride`-th float, and always those around each power of two, zero, infinity and the
/// ends of NaN, of both signs. `check(float)` is called from several threads; false counts as
/// wrong.
template <typename Check>
Tally sweep(std::uint32_t stride, const Check& check) {
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  std::atomic<std::uint64_t> next{0};
  std::atomic<std::uint64_t> tried{0};
  std::atomic<std::uint64_t> wrong{0};
  std::atomic<std::uint32_t> first_wrong{0};
  const auto try_one = [&](std::uint32_t bits) {
    if (!check(float_of(bits)) && wrong++ == 0) {
      first_wrong = bits;
    }
  };
  const auto work = [&] {
    const std::uint64_t piece = kPiece * stride;
    for (std::uint64_t begin = next.fetch_add(piece); begin < kAll; begin = next.fetch_add(piece)) {
      std::uint64_t count = 0;
      for (std::uint64_t bits = begin; bits < kAll && bits < begin + piece; bits += stride) {
        try_one(static_cast<std::uint32_t>(bits));
        ++count;
      }
      tried += count;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back(work);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (stride > 1) {
    constexpr std::uint32_t kAround = 8;
    for (std::uint32_t exponent = 0; exponent < 512; ++exponent) {  // with the sign
      for (std::uint32_t i = 0; i < 2 * kAround; ++i) {
        try_one((exponent << 23) + i - kAround);
        ++tried;
      }
    }
  }
  return {tried, wrong, first_wrong};
}

}  // namespace flexcomp::exhaustive
