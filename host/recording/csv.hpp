#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace flexcomp::recording {

/// A table of numbers with named columns; NaN stands for an empty cell.
struct NumberTable {
  std::string file;  ///< where it came from, for messages
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  /// Line of the file that a row stood in, from 1.
  std::size_t line(std::size_t row) const { return lines[row]; }

  std::vector<std::size_t> lines;
};

/// The largest number of a cell, in any unit, times since an epoch in ns among them. What is larger
/// was never measured, and its square has no number.
constexpr double kLargestCell = 1e30;

/// Reads a CSV file of numbers: the columns' names in line 1, the same number of cells in every
/// line, decimal points, empty cells allowed. A byte-order mark, CRLF line ends and blank lines are
/// skipped.
///
/// Throws InputError with file, line and column for a wrong number of cells, a cell that is no
/// finite number or a larger one than `kLargestCell`, a column that is unnamed or named twice, a
/// line of more than 64 KiB, or no rows.
NumberTable read_csv(const std::filesystem::path& path);

/// Appends a number in the shortest form that reads back to the same bits; nothing for NaN.
void append_number(double value, std::string* text);

}  // namespace flexcomp::recording
