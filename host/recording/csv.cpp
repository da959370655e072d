#include "recording/csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <system_error>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "recording/lines.hpp"

namespace flexcomp::recording {
namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) {
      return cells;
    }
    begin = comma + 1;
  }
}

/// Tables of others have semicolons or tabs. Without a word here, each row would be no number.
void refuse_other_separators(const std::string& file, std::string_view line) {
  if (line.find(',') == std::string_view::npos &&
      line.find_first_of(";\t") != std::string_view::npos) {
    throw InputError(fmt::format(
        "{}:1: {} separate the columns, not commas; flexcomp convert makes a recording of it", file,
        line.find(';') == std::string_view::npos ? "tabs" : "semicolons"));
  }
}

std::vector<std::string> read_header(const std::string& file, Lines* lines) {
  std::string_view line;
  if (!lines->next(&line)) {
    throw InputError(fmt::format("{}: the file is blank", file));
  }
  if (lines->number() != 1) {
    throw InputError(fmt::format("{}:1: the line is blank; expected the columns' names", file));
  }
  refuse_long_line(file, lines->number(), line);
  refuse_other_separators(file, line);
  std::vector<std::string> columns;
  std::set<std::string_view> names;
  for (const std::string_view name : split(line)) {
    if (name.empty()) {
      throw InputError(fmt::format("{}:1: column {} has no name", file, columns.size() + 1));
    }
    if (!names.insert(name).second) {
      throw InputError(fmt::format("{}:1: column '{}' appears twice", file, files::one_line(name)));
    }
    columns.emplace_back(name);
  }
  return columns;
}

}  // namespace

NumberTable read_csv(const std::filesystem::path& path) {
  const std::string text = files::read_text(path);
  NumberTable table;
  table.file = path.string();
  Lines lines(text);
  table.columns = read_header(table.file, &lines);
  std::string_view line;
  while (lines.next(&line)) {
    refuse_long_line(table.file, lines.number(), line);
    const std::vector<std::string_view> cells = split(line);
    if (cells.size() != table.columns.size()) {
      throw InputError(fmt::format("{}:{}: expected {} cells as in the header, found {}",
                                   table.file, lines.number(), table.columns.size(), cells.size()));
    }
    std::vector<double> row(cells.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string_view cell = cells[i];
      if (cell.empty()) {
        continue;
      }
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), row[i]);
      if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(row[i])) {
        throw InputError(fmt::format("{}:{}: column '{}': '{}' is not a finite number", table.file,
                                     lines.number(), files::one_line(table.columns[i]),
                                     files::one_line(cell)));
      }
      if (std::abs(row[i]) > kLargestCell) {
        throw InputError(fmt::format(
            "{}:{}: column '{}': '{}' is larger than any measurement; expected at most {:g}",
            table.file, lines.number(), files::one_line(table.columns[i]), files::one_line(cell),
            kLargestCell));
      }
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(lines.number());
  }
  if (table.rows.empty()) {
    throw InputError(fmt::format("{}: no rows below the header", table.file));
  }
  return table;
}

void append_number(double value, std::string* text) {
  if (std::isnan(value)) {
    return;
  }
  char digits[32];
  const auto result = std::to_chars(std::begin(digits), std::end(digits), value);
  text->append(std::begin(digits), result.ptr);
}

}  // namespace flexcomp::recording
