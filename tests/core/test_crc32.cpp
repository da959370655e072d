#include <random>
#include <vector>

#include "crc32.hpp"
#include "unity_main.hpp"

using flexcomp::crc32;

namespace {

/// Bit by bit, as IEEE 802.3 defines it.
std::uint32_t by_bits(const std::vector<unsigned char>& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

void it_has_the_published_check_value() {
  TEST_ASSERT_EQUAL_HEX32(0xCBF43926, crc32("123456789", 9));
}

void in_pieces_of_any_size_at_any_place_it_is_the_same() {
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 200; ++size) {
    std::vector<unsigned char> bytes(size);
    for (unsigned char& byte : bytes) {
      byte = static_cast<unsigned char>(random());
    }
    const std::size_t first = size == 0 ? 0 : random() % size;
    const std::uint32_t begun = crc32(bytes.data(), first);
    TEST_ASSERT_EQUAL_HEX32(by_bits(bytes), crc32(bytes.data(), size));
    TEST_ASSERT_EQUAL_HEX32(by_bits(bytes), crc32(bytes.data() + first, size - first, begun));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(it_has_the_published_check_value);
  RUN_TEST(in_pieces_of_any_size_at_any_place_it_is_the_same);
  return UNITY_END();
}
