#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace flexcomp::fuzz {

/// Hands out a fuzzer's bytes from the front, so that a seed can be written by hand; zeros at the
/// end.
class ByteSource {
 public:
  ByteSource(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool is_empty() const { return left_ == 0; }

  template <typename Number>
  Number take() {
    Number value{};
    take_into(&value, sizeof value);
    return value;
  }

  void take_into(void* to, std::size_t size) {
    const std::size_t count = std::min(size, left_);
    std::memcpy(to, data_, count);
    data_ += count;
    left_ -= count;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// Ends the process, which the fuzzer reports with the input, unless `condition` holds.
inline void expect(bool condition, const char* promise) {
  if (!condition) {
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
  }
}

}  // namespace flexcomp::fuzz
