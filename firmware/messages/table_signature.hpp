#pragma once

#include <optional>

#include "messages/cmac.hpp"
#include "messages/table_trailer.hpp"

namespace flexcomp {

enum class Signature : std::uint8_t {
  good,
  none,   ///< no trailer
  wrong,  ///< of another key, or something was changed after it was made
};

/// The trailer of a table of `size` bytes; none if mbedTLS fails.
std::optional<TableTrailer> sign_table(const AuthenticationKey& key, const void* table,
                                       std::size_t size, std::uint32_t counter);

/// Is a table with its trailer, `size` bytes together, as it was signed with this key? `counter` is
/// set where it is. Says nothing of the table's own fields: `Table::open`. Cost: a pass over the
/// bytes. If mbedTLS fails the signature counts as wrong.
Signature check_signature(const AuthenticationKey& key, const void* data, std::size_t size,
                          std::uint32_t* counter);

}  // namespace flexcomp
