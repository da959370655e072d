#include "messages/table_signature.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kTagPlace = offsetof(TableTrailer, tag);

/// The tag of a table and of what stands before the tag in its trailer. False if mbedTLS fails.
bool compute_tag(const AuthenticationKey& key, const std::uint8_t* table, std::size_t size,
                 const TableTrailer& trailer, Cmac::Code* tag) {
  Cmac cmac(key);
  cmac.begin();
  cmac.add(table, size);
  cmac.add(reinterpret_cast<const std::uint8_t*>(&trailer), kTagPlace);
  return cmac.end(tag);
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

std::optional<TableTrailer> sign_table(const AuthenticationKey& key, const void* table,
                                       std::size_t size, std::uint32_t counter) {
  TableTrailer trailer{kTableTrailerMagic, counter, {}};
  if (!compute_tag(key, static_cast<const std::uint8_t*>(table), size, trailer, &trailer.tag)) {
    return std::nullopt;
  }
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
  Cmac::Code tag{};
  if (!compute_tag(key, bytes, table, trailer, &tag) || !are_equal(trailer.tag, tag)) {
    return Signature::wrong;
  }
  *counter = trailer.counter;
  return Signature::good;
}

}  // namespace flexcomp
