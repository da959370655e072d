#include <vector>

#include "messages/table_signature.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr AuthenticationKey kKey = {0x2b, 0x7e, 0x15, 0x16, 0x28, 0xae, 0xd2, 0xa6,
                                    0xab, 0xf7, 0x15, 0x88, 0x09, 0xcf, 0x4f, 0x3c};
constexpr std::uint32_t kCounter = 0x01020304;

/// As large as it says; what else is in it does not matter to its signature.
Bytes table() {
  Bytes bytes(300);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(7 * i);
  }
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(bytes.data() + 8, &size, sizeof size);
  return bytes;
}

Bytes signed_table(const AuthenticationKey& key = kKey) {
  Bytes bytes = table();
  const TableTrailer trailer = sign_table(key, bytes.data(), bytes.size(), kCounter).value();
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&trailer);
  bytes.insert(bytes.end(), begin, begin + sizeof trailer);
  return bytes;
}

Signature check(const Bytes& bytes, std::uint32_t* counter) {
  return check_signature(kKey, bytes.data(), bytes.size(), counter);
}

void a_signed_table_is_the_table_and_its_trailer() {
  const Bytes bytes = signed_table();
  TEST_ASSERT_EQUAL(table().size(), bytes_of_table(bytes.data(), bytes.size()));
  TEST_ASSERT_EQUAL_MEMORY(table().data(), bytes.data(), table().size());
  TEST_ASSERT_EQUAL_MEMORY("FCS1\x04\x03\x02\x01", bytes.data() + table().size(), 8);
  std::uint32_t counter = 0;
  TEST_ASSERT_TRUE(check(bytes, &counter) == Signature::good);
  TEST_ASSERT_EQUAL_HEX32(kCounter, counter);
}

/// RFC 4493's code of the bytes before it, by the class whose test has that document's vectors.
void the_tag_is_a_cmac_of_all_before_it() {
  const Bytes bytes = signed_table();
  Cmac::Code expected{};
  TEST_ASSERT_TRUE(Cmac(kKey).compute(bytes.data(), bytes.size() - expected.size(), &expected));
  TEST_ASSERT_EQUAL_MEMORY(expected.data(), bytes.data() + bytes.size() - expected.size(),
                           expected.size());
}

void no_bit_can_be_changed() {
  Bytes bytes = signed_table();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    std::uint32_t counter = 99;
    TEST_ASSERT_FALSE(check(bytes, &counter) == Signature::good);
    TEST_ASSERT_EQUAL(99, counter);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  }
}

void no_part_of_it_and_nothing_more_is_signed() {
  Bytes bytes = signed_table();
  std::uint32_t counter = 0;
  bytes.push_back(0);
  TEST_ASSERT_TRUE(check(bytes, &counter) == Signature::none);
  bytes = signed_table();
  while (!bytes.empty()) {
    bytes.pop_back();
    TEST_ASSERT_TRUE(check(bytes, &counter) == Signature::none);
  }
  TEST_ASSERT_TRUE(check_signature(kKey, nullptr, 0, &counter) == Signature::none);
}

void a_signature_of_another_key_is_wrong() {
  AuthenticationKey other = kKey;
  other[15] ^= 1U;
  std::uint32_t counter = 0;
  TEST_ASSERT_TRUE(check(signed_table(other), &counter) == Signature::wrong);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_signed_table_is_the_table_and_its_trailer);
  RUN_TEST(the_tag_is_a_cmac_of_all_before_it);
  RUN_TEST(no_bit_can_be_changed);
  RUN_TEST(no_part_of_it_and_nothing_more_is_signed);
  RUN_TEST(a_signature_of_another_key_is_wrong);
  return UNITY_END();
}
