#include "messages/cmac.hpp"

#include <algorithm>

namespace flexcomp {
namespace {

constexpr std::uint8_t kPadding = 0x80;  // RFC 4493, 2.4: a one, then zeros

void add_to(const Cmac::Code& other, Cmac::Code* block) {
  for (std::size_t i = 0; i < block->size(); ++i) {
    (*block)[i] = static_cast<std::uint8_t>((*block)[i] ^ other[i]);
  }
}

/// Twice `block` in GF(2^128): RFC 4493, 2.3.
Cmac::Code doubled(const Cmac::Code& block) {
  constexpr unsigned kReduction = 0x87;
  Cmac::Code result{};
  unsigned carry = 0;
  for (std::size_t i = block.size(); i-- > 0;) {
    const unsigned byte = block[i];
    result[i] = static_cast<std::uint8_t>(byte << 1U | carry);
    carry = byte >> 7U;
  }
  result.back() = static_cast<std::uint8_t>(result.back() ^ carry * kReduction);
  return result;
}

}  // namespace

Cmac::Cmac(const AuthenticationKey& key) {
  mbedtls_aes_init(&aes_);
  has_key_ = mbedtls_aes_setkey_enc(&aes_, key.data(), static_cast<unsigned>(8 * key.size())) == 0;
  works_ = has_key_;
  whole_key_ = doubled(encrypted(Code{}));
  padded_key_ = doubled(whole_key_);
  begin();
}

Cmac::~Cmac() { mbedtls_aes_free(&aes_); }

Cmac::Code Cmac::encrypted(const Code& block) {
  Code result{};
  works_ =
      works_ && mbedtls_aes_crypt_ecb(&aes_, MBEDTLS_AES_ENCRYPT, block.data(), result.data()) == 0;
  return result;
}

void Cmac::begin() {
  works_ = has_key_;
  state_ = Code{};
  in_block_ = 0;
}

void Cmac::add(const std::uint8_t* data, std::size_t size) {
  while (size > 0) {
    if (in_block_ == kBlock) {  // not the last one: more comes
      add_to(block_, &state_);
      state_ = encrypted(state_);
      in_block_ = 0;
    }
    const std::size_t count = std::min(size, kBlock - in_block_);
    std::copy_n(data, count, block_.begin() + in_block_);
    in_block_ += count;
    data += count;
    size -= count;
  }
}

bool Cmac::end(Code* code) {
  if (in_block_ == kBlock) {
    add_to(whole_key_, &block_);
  } else {
    block_[in_block_] = kPadding;
    std::fill(block_.begin() + in_block_ + 1, block_.end(), std::uint8_t{0});
    add_to(padded_key_, &block_);
  }
  add_to(block_, &state_);
  const Code computed = encrypted(state_);
  if (works_) {
    *code = computed;
  }
  return works_;
}

bool Cmac::compute(const std::uint8_t* data, std::size_t size, Code* code) {
  begin();
  add(data, size);
  return end(code);
}

}  // namespace flexcomp
