#pragma once

#include "messages/messages.hpp"
#include "messages/table_signature.hpp"

namespace flexcomp {

/// Which tables a node with a key takes: those that are signed with it, and of these none that is
/// older than the newest that has run.
class TableAdmission {
 public:
  /// `highest`: the highest counter of a table that has run, 0 if none has.
  TableAdmission(const AuthenticationKey& key, std::uint32_t highest)
      : key_(key), highest_(highest) {}

  /// ok, with the table's counter, or table_not_signed, table_forged, table_older. A pass over the
  /// bytes: not for the real-time thread.
  Reply judge(const void* data, std::size_t size, std::uint32_t* counter) const;

  void has_run(std::uint32_t counter) { highest_ = counter > highest_ ? counter : highest_; }
  std::uint32_t highest() const { return highest_; }

 private:
  AuthenticationKey key_;
  std::uint32_t highest_;
};

}  // namespace flexcomp
