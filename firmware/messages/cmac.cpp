#include "messages/cmac.hpp"

#include <mbedtls/cipher.h>
#include <mbedtls/cmac.h>

#include <stdexcept>

namespace flexcomp {

void Cmac::Free::operator()(mbedtls_cipher_context_t* context) const {
  mbedtls_cipher_free(context);  // wipes the key
  delete context;
}

Cmac::Cmac(const AuthenticationKey& key) : context_(new mbedtls_cipher_context_t) {
  mbedtls_cipher_init(context_.get());
  const mbedtls_cipher_info_t* aes = mbedtls_cipher_info_from_type(MBEDTLS_CIPHER_AES_128_ECB);
  const bool is_ready = aes != nullptr && mbedtls_cipher_setup(context_.get(), aes) == 0 &&
                        mbedtls_cipher_cmac_starts(context_.get(), key.data(), 8 * key.size()) == 0;
  if (!is_ready) {
    throw std::runtime_error("mbedTLS does not take the key");
  }
}

bool Cmac::compute(const std::uint8_t* data, std::size_t size, Code* code) {
  Code computed;
  const bool done = mbedtls_cipher_cmac_reset(context_.get()) == 0 &&
                    mbedtls_cipher_cmac_update(context_.get(), data, size) == 0 &&
                    mbedtls_cipher_cmac_finish(context_.get(), computed.data()) == 0;
  if (done) {
    *code = computed;
  }
  return done;
}

}  // namespace flexcomp
