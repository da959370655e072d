/// Between double and 64-bit integers, which no instruction converts: by those for 32 bits, in the
/// place of libgcc's software (the names are those of Arm's run-time ABI, 4.1.2).
#include <cstdint>

namespace {

constexpr double kWord = 4294967296.0;  // 2^32

}  // namespace

extern "C" {

// The halves convert exactly and the product is exact: the sum rounds once, as it must.
[[gnu::used]] double __aeabi_ul2d(std::uint64_t value) {
  const auto high = static_cast<std::uint32_t>(value >> 32);
  const auto low = static_cast<std::uint32_t>(value & 0xFFFFFFFFU);
  return static_cast<double>(high) * kWord + static_cast<double>(low);
}

[[gnu::used]] double __aeabi_l2d(std::int64_t value) {
  const auto high = static_cast<std::int32_t>(value >> 32);
  const auto low = static_cast<std::uint32_t>(value & 0xFFFFFFFF);
  return static_cast<double>(high) * kWord + static_cast<double>(low);
}

[[gnu::used]] std::uint64_t __aeabi_d2ulz(double value) {
  const auto high = static_cast<std::uint32_t>(value / kWord);
  const auto low = static_cast<std::uint32_t>(value - static_cast<double>(high) * kWord);
  return std::uint64_t{high} << 32 | low;
}

}  // extern "C"
