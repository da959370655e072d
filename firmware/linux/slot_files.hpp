#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flexcomp {

/// Tables that came over the bus, kept in a directory so that the node starts with the last one:
/// two files, and one that names the file in use. Each is written aside and renamed, so that a loss
/// of power leaves the table that was there.
///
/// With a key a new table is first `stage`d, beside the one in use, and only once it has run
/// `confirm`ed; what ends before starts with the one in use again. One more file holds the highest
/// counter of a table that has run.
class SlotFiles {
 public:
  explicit SlotFiles(std::string directory) : directory_(std::move(directory)) {}

  /// The bytes of the table that was last in use; of the other one if that is missing, damaged or
  /// larger than `most` bytes; nothing if neither can be opened.
  std::optional<std::vector<char>> newest(std::size_t most) const;

  /// The bytes of the table that is named as the one in use; nothing if none is, or if it is
  /// missing, damaged or larger than `most` bytes.
  std::optional<std::vector<char>> confirmed(std::size_t most) const;

  /// Keeps a table and names it as the one in use. Throws std::runtime_error if the disk refuses.
  void keep(const void* data, std::size_t size);

  /// Keeps a table beside the one in use. Throws std::runtime_error if the disk refuses.
  void stage(const void* data, std::size_t size);

  /// Names what was staged last as the table in use; false if nothing is. Throws std::runtime_error
  /// if the disk refuses.
  bool confirm();

  /// The highest counter that was kept; 0 if there never was one. Throws std::runtime_error where a
  /// file is in its place that holds none.
  std::uint32_t counter() const;

  /// Keeps a counter if it is higher. Throws std::runtime_error if the disk refuses.
  void raise_counter(std::uint32_t counter);

 private:
  std::string path(const char* name) const { return directory_ + "/" + name; }
  std::optional<std::string> active() const;
  std::optional<std::vector<char>> table(const std::string& name, std::size_t most) const;

  std::string directory_;
  std::string staged_;  ///< name of the file, empty for none
};

}  // namespace flexcomp
