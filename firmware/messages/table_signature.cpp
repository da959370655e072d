#include "messages/table_signature.hpp"

#include <stdexcept>
#include <vector>

namespace flexcomp {
namespace {

constexpr std::size_t kTagPlace = offsetof(TableTrailer, tag);

Cmac::Code tag_of(const AuthenticationKey& key, const std::uint8_t* data, std::size_t size) {
  Cmac cmac(key);
  Cmac::Code tag{};
  if (!cmac.compute(data, size, &tag)) {
    throw std::runtime_error("mbedTLS does not compute a table's tag");
  }
  return tag;
}

/// In the same time whatever they are, so that nobody learns a tag byte by byte.
bool are_equal(const Cmac::Code& a, const Cmac::Code& b) {
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return difference == 0;
}

}  // namespace

TableTrailer sign_table(const AuthenticationKey& key, const void* table, std::size_t size,
                        std::uint32_t counter) {
  TableTrailer trailer{kTableTrailerMagic, counter, {}};
  const auto* bytes = static_cast<const std::uint8_t*>(table);
  const auto* words = reinterpret_cast<const std::uint8_t*>(&trailer);
  std::vector<std::uint8_t> content(bytes, bytes + size);
  content.insert(content.end(), words, words + kTagPlace);
  trailer.tag = tag_of(key, content.data(), content.size());
  return trailer;
}

Signature check_signature(const AuthenticationKey& key, const void* data, std::size_t size,
                          std::uint32_t* counter) {
  const std::size_t table = bytes_of_table(data, size);
  if (table == size) {
    return Signature::none;
  }
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  TableTrailer trailer{};
  std::memcpy(&trailer, bytes + table, sizeof trailer);
  if (!are_equal(trailer.tag, tag_of(key, bytes, table + kTagPlace))) {
    return Signature::wrong;
  }
  *counter = trailer.counter;
  return Signature::good;
}

}  // namespace flexcomp
