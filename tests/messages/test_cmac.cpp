// Published vectors: RFC 4493, section 4, which are also those of NIST SP 800-38B for AES-128
// (which has 20 bytes where the RFC has 40).
#include <mbedtls/cipher.h>
#include <mbedtls/cmac.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "messages/cmac.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

std::vector<std::uint8_t> bytes(const std::string& hex) {
  std::vector<std::uint8_t> result;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    result.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return result;
}

AuthenticationKey key(const std::string& hex) {
  AuthenticationKey result{};
  const std::vector<std::uint8_t> content = bytes(hex);
  std::copy(content.begin(), content.end(), result.begin());
  return result;
}

const std::string kKey = "2b7e151628aed2a6abf7158809cf4f3c";
const std::string kMessage =
    "6bc1bee22e409f96e93d7e117393172aae2d8a571e03ac9c9eb76fac45af8e51"
    "30c81c46a35ce411e5fbc1191a0a52eff69f2445df4f9b17ad2b417be66c3710";

void expect_code(Cmac* cmac, std::size_t size, const std::string& expected) {
  const std::vector<std::uint8_t> message = bytes(kMessage);
  Cmac::Code code{};
  TEST_ASSERT_TRUE(cmac->compute(message.data(), size, &code));
  TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes(expected).data(), code.data(), code.size());
}

void published_vectors_are_met() {
  Cmac cmac(key(kKey));
  expect_code(&cmac, 0, "bb1d6929e95937287fa37d129b756746");
  expect_code(&cmac, 16, "070a16b46b4d4144f79bdd9dd04a287c");
  expect_code(&cmac, 20, "7d85449ea6ea19c823a7bf78837dfade");
  expect_code(&cmac, 40, "dfa66747de9ae63030ca32611497c827");
  expect_code(&cmac, 64, "51f0bebf7e3b9d92fc49741779363cfe");
}

void a_code_depends_on_nothing_that_came_before() {
  Cmac cmac(key(kKey));
  for (int i = 0; i < 3; ++i) {
    expect_code(&cmac, 40, "dfa66747de9ae63030ca32611497c827");
    expect_code(&cmac, 16, "070a16b46b4d4144f79bdd9dd04a287c");
  }
}

void another_key_gives_another_code() {
  Cmac cmac(key("2b7e151628aed2a6abf7158809cf4f3d"));
  const std::vector<std::uint8_t> message = bytes(kMessage);
  Cmac::Code code{};
  TEST_ASSERT_TRUE(cmac.compute(message.data(), message.size(), &code));
  TEST_ASSERT_FALSE(code[0] == 0x51 && code[1] == 0xf0);
}

void pieces_give_the_code_of_mbedtls_for_the_whole() {
  std::mt19937 random(4493);
  const AuthenticationKey secret = key(kKey);
  const mbedtls_cipher_info_t* aes = mbedtls_cipher_info_from_type(MBEDTLS_CIPHER_AES_128_ECB);
  Cmac cmac(secret);
  for (std::size_t size = 0; size < 200; ++size) {
    std::vector<std::uint8_t> message(size + 1);
    std::generate(message.begin(), message.end(),
                  [&random] { return static_cast<std::uint8_t>(random()); });
    Cmac::Code expected{};
    TEST_ASSERT_EQUAL(0, mbedtls_cipher_cmac(aes, secret.data(), 8 * secret.size(), message.data(),
                                             size, expected.data()));
    cmac.begin();
    for (std::size_t done = 0; done < size;) {
      const std::size_t piece = std::min<std::size_t>(random() % 40, size - done);
      cmac.add(message.data() + done, piece);
      done += piece;
    }
    Cmac::Code code{};
    TEST_ASSERT_TRUE(cmac.end(&code));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected.data(), code.data(), code.size());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(pieces_give_the_code_of_mbedtls_for_the_whole);
  RUN_TEST(published_vectors_are_met);
  RUN_TEST(a_code_depends_on_nothing_that_came_before);
  RUN_TEST(another_key_gives_another_code);
  return UNITY_END();
}
