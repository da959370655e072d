#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/table_store.hpp"

namespace flexcomp {

/// Tables that came over the bus, kept in a directory so that the node starts with the last one:
/// two files, and one that names the file in use. Each is written aside and renamed, so that a loss
/// of power leaves the table that was there.
class SlotFiles {
 public:
  explicit SlotFiles(std::string directory) : directory_(std::move(directory)) {}

  /// The bytes of the table that was last in use; of the other one if that is missing, damaged or
  /// larger than `most` bytes; nothing if neither can be opened.
  std::optional<std::vector<char>> newest(std::size_t most) const;

  /// Keeps a table and names it as the one in use. Throws std::runtime_error if the disk refuses.
  void keep(const void* data, std::size_t size);

 private:
  std::string path(const char* name) const { return directory_ + "/" + name; }
  std::string active() const;

  std::string directory_;
};

}  // namespace flexcomp
