#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

struct mbedtls_cipher_context_t;  // NOLINT(readability-identifier-naming): mbedTLS's

namespace flexcomp {

/// A secret that all who authenticate to each other hold; 128 bits.
using AuthenticationKey = std::array<std::uint8_t, 16>;

/// AES-128-CMAC (NIST SP 800-38B, RFC 4493) by mbedTLS. Allocates when made, and never after.
class Cmac {
 public:
  using Code = std::array<std::uint8_t, 16>;

  /// Throws std::runtime_error if mbedTLS does not take the key (out of memory).
  explicit Cmac(const AuthenticationKey& key);

  /// The code of `size` bytes; `data` is not null. False, with `code` untouched, if mbedTLS fails.
  bool compute(const std::uint8_t* data, std::size_t size, Code* code);

 private:
  struct Free {
    void operator()(mbedtls_cipher_context_t* context) const;
  };

  std::unique_ptr<mbedtls_cipher_context_t, Free> context_;
};

}  // namespace flexcomp
