#pragma once

#include <mbedtls/aes.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "messages/authentication_key.hpp"

namespace flexcomp {

/// AES-128-CMAC (NIST SP 800-38B, RFC 4493) over the block cipher of mbedTLS. mbedTLS has a CMAC
/// too, but one that allocates, which a microcontroller without a heap cannot.
///
/// A code is computed in one call, or piece by piece: `begin`, `add` as often as there are pieces,
/// `end`. Constant time for a given size; no heap.
class Cmac {
 public:
  static constexpr std::size_t kBlock = 16;
  using Code = std::array<std::uint8_t, kBlock>;

  explicit Cmac(const AuthenticationKey& key);
  ~Cmac();  ///< wipes the key
  Cmac(const Cmac&) = delete;
  Cmac& operator=(const Cmac&) = delete;

  /// The code of `size` bytes; `data` is not null. False, with `code` untouched, if mbedTLS fails,
  /// as a build for hardware that encrypts may.
  bool compute(const std::uint8_t* data, std::size_t size, Code* code);

  void begin();
  void add(const std::uint8_t* data, std::size_t size);
  /// False, with `code` untouched, if mbedTLS has failed since `begin`.
  bool end(Code* code);

 private:
  Code encrypted(const Code& block);

  mbedtls_aes_context aes_;
  bool has_key_ = false;
  bool works_ = false;
  Code whole_key_{};   ///< K1: for a last block that is whole
  Code padded_key_{};  ///< K2: for one that was padded
  Code state_{};
  Code block_{};  ///< the last bytes that came, of which there may be more
  std::size_t in_block_ = 0;
};

}  // namespace flexcomp
