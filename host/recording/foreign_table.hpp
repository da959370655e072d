#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "recording/csv.hpp"

namespace flexcomp::recording {

/// Where the table stands in a file that others wrote.
struct ForeignLayout {
  std::size_t header_line = 1;  ///< line of the columns' names, from 1
  std::size_t first_row = 0;    ///< line of the first row, where it is not the one after the names
  /// Of the first columns, where no line names them; those behind are called by their numbers,
  /// from 1. Empty: a line does.
  std::vector<std::string> names;
};

/// A table of text as others write it. Commas, semicolons or tabs separate its cells, whichever the
/// line of names (the first row, where there is none) has most of, or blanks where it has none of
/// them. A cell may stand in double quotes (RFC 4180), and a `#` before the names. A byte-order
/// mark, CRLF line ends, blank lines and a separator at the end of every line are skipped.
class ForeignTable {
 public:
  /// Throws InputError with file and line where the names are not there, or more of them are given
  /// than there are cells.
  ForeignTable(const std::filesystem::path& path, const ForeignLayout& layout);

  const std::string& file() const { return file_; }  ///< where it came from, for messages
  const std::vector<std::string>& columns() const { return columns_; }

  /// The chosen columns as numbers. NaN where a cell is empty or says nan, na, n/a, null or none.
  /// Decimal commas are read where commas do not separate cells. Of a column with both commas and
  /// points one separates thousands, and it is refused.
  ///
  /// Throws InputError with file, line and column for a cell that is no finite number, a row with
  /// another number of cells than there are names, a quote that does not end, a line of more than
  /// 64 KiB, or no rows.
  NumberTable numbers(const std::vector<std::size_t>& chosen) const;

 private:
  void find_names();
  void take_names();

  std::string file_;
  std::string text_;
  ForeignLayout layout_;
  char separator_ = ',';
  std::vector<std::string> columns_;
};

}  // namespace flexcomp::recording
