#include "recording/csv.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <system_error>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"

namespace flexcomp::recording {
namespace {

/// Longest line that is looked at: a recording's has some hundred characters, and one of a gigabyte
/// without a line end is no table.
constexpr std::size_t kLongestLine = 1 << 16;

std::string_view trimmed(std::string_view cell) {
  const auto begin = cell.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    return {};
  }
  return cell.substr(begin, cell.find_last_not_of(" \t") - begin + 1);
}

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

/// Hands out a text's lines without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
      rest_.remove_prefix(kByteOrderMark.size());
    }
  }

  /// Next line that is not blank; false at the end.
  bool next(std::string_view* line) {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      *line = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++number_;
      if (!line->empty() && line->back() == '\r') {
        line->remove_suffix(1);
      }
      if (!trimmed(*line).empty()) {
        return true;
      }
    }
    return false;
  }

  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

void refuse_long_line(const std::string& file, const Lines& lines, std::string_view line) {
  if (line.size() > kLongestLine) {
    throw InputError(fmt::format("{}:{}: the line has {} characters; expected at most {}", file,
                                 lines.number(), line.size(), kLongestLine));
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
  refuse_long_line(file, *lines, line);
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
    refuse_long_line(table.file, lines, line);
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
