#include "recording/foreign_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>

#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "recording/lines.hpp"

namespace flexcomp::recording {
namespace {

constexpr char kBlank = ' ';

char separator_of(std::string_view names) {
  constexpr std::array<char, 3> kCandidates = {';', '\t', ','};
  char best = kBlank;
  std::ptrdiff_t most = 0;
  for (const char candidate : kCandidates) {
    const std::ptrdiff_t count = std::count(names.begin(), names.end(), candidate);
    if (count > most) {
      most = count;
      best = candidate;
    }
  }
  return best;
}

/// Takes a line apart. A quote within a quoted cell is written twice.
class Cells {
 public:
  Cells(std::string_view line, char separator) : rest_(line), separator_(separator) {}

  /// False where a quote does not end, or ends within a cell.
  bool split(std::vector<std::string>* cells) {
    do {
      skip_blanks();
      cells->emplace_back();
      if (!take_cell(&cells->back())) {
        return false;
      }
    } while (take_separator());
    return rest_.empty();
  }

 private:
  bool starts_with(char character) const { return !rest_.empty() && rest_.front() == character; }

  void skip_blanks() {
    while (starts_with(' ') || (separator_ != '\t' && starts_with('\t'))) {
      rest_.remove_prefix(1);
    }
  }

  bool take_separator() {
    const std::size_t before = rest_.size();
    skip_blanks();
    if (separator_ == kBlank) {
      return rest_.size() < before && !rest_.empty();
    }
    if (!starts_with(separator_)) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }

  bool take_cell(std::string* cell) {
    if (starts_with('"')) {
      return take_quoted(cell);
    }
    const std::string_view ends =
        separator_ == kBlank ? std::string_view(" \t") : std::string_view(&separator_, 1);
    const std::string_view plain = rest_.substr(0, rest_.find_first_of(ends));
    rest_.remove_prefix(plain.size());
    *cell = trimmed(plain);
    return true;
  }

  bool take_quoted(std::string* cell) {
    rest_.remove_prefix(1);
    for (;;) {
      const std::size_t quote = rest_.find('"');
      if (quote == std::string_view::npos) {
        return false;
      }
      cell->append(rest_.substr(0, quote));
      rest_.remove_prefix(quote + 1);
      if (!starts_with('"')) {
        return true;
      }
      cell->push_back('"');
      rest_.remove_prefix(1);
    }
  }

  std::string_view rest_;
  char separator_;
};

void split(const std::string& file, std::size_t number, std::string_view line, char separator,
           std::vector<std::string>* cells) {
  refuse_long_line(file, number, line);
  cells->clear();
  if (!Cells(line, separator).split(cells)) {
    throw InputError(fmt::format("{}:{}: a quote does not end where its cell ends", file, number));
  }
}

std::string_view without_comment_mark(std::string_view names) {
  const std::string_view line = trimmed(names);
  return !line.empty() && line.front() == '#' ? line.substr(1) : names;
}

bool is_missing(std::string_view cell) {
  constexpr std::size_t kLongest = 4;
  if (cell.size() > kLongest) {
    return false;
  }
  std::string small(cell);
  std::transform(small.begin(), small.end(), small.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  constexpr std::array<std::string_view, 6> kMissing = {"", "nan", "na", "n/a", "null", "none"};
  return std::find(kMissing.begin(), kMissing.end(), small) != kMissing.end();
}

/// Reads the numbers of a column, whose first mark between whole and part says what the others' is.
class Column {
 public:
  /// Nothing for a cell that is no finite number.
  bool read(const std::string& cell, double* number) {
    if (is_missing(cell)) {
      *number = std::numeric_limits<double>::quiet_NaN();
      return true;
    }
    std::string digits = cell;
    const std::size_t mark = digits.find_first_of(".,");
    if (mark != std::string::npos) {
      mark_ = mark_ == '\0' ? digits[mark] : mark_;
      if (digits[mark] != mark_) {
        return false;
      }
      digits[mark] = '.';
    }
    const bool has_plus = digits.size() > 1 && digits[0] == '+' && digits[1] != '-';
    const char* begin = digits.data() + (has_plus ? 1 : 0);
    const char* end = digits.data() + digits.size();
    const auto [read, error] = std::from_chars(begin, end, *number);
    return error == std::errc{} && read == end && std::isfinite(*number);
  }

 private:
  char mark_ = '\0';
};

}  // namespace

ForeignTable::ForeignTable(const std::filesystem::path& path, const ForeignLayout& layout)
    : file_(path.string()), text_(files::read_text(path)), layout_(layout) {
  if (layout_.names.empty()) {
    find_names();
  } else {
    layout_.header_line = 0;
    take_names();
  }
}

void ForeignTable::find_names() {
  Lines lines(text_);
  std::string_view line;
  while (lines.next(&line) && lines.number() < layout_.header_line) {
  }
  if (lines.number() != layout_.header_line) {
    throw InputError(
        fmt::format("{}:{}: expected the columns' names in this line", file_, layout_.header_line));
  }
  line = without_comment_mark(line);
  separator_ = separator_of(line);
  split(file_, lines.number(), line, separator_, &columns_);
}

void ForeignTable::take_names() {
  Lines lines(text_);
  std::string_view line;
  while (lines.next(&line) && lines.number() < layout_.first_row) {
  }
  separator_ = separator_of(line);
  split(file_, lines.number(), line, separator_, &columns_);
  if (layout_.names.size() > columns_.size()) {
    throw InputError(fmt::format("{}:{}: expected {} cells as there are names, found {}", file_,
                                 lines.number(), layout_.names.size(), columns_.size()));
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i] = i < layout_.names.size() ? layout_.names[i] : std::to_string(i + 1);
  }
}

NumberTable ForeignTable::numbers(const std::vector<std::size_t>& chosen) const {
  NumberTable table;
  table.file = file_;
  std::vector<Column> readers(chosen.size());
  for (const std::size_t column : chosen) {
    table.columns.push_back(columns_[column]);
  }
  const std::size_t first = std::max(layout_.first_row, layout_.header_line + 1);
  Lines lines(text_);
  std::string_view line;
  std::vector<std::string> cells;
  while (lines.next(&line)) {
    if (lines.number() < first) {
      continue;
    }
    split(file_, lines.number(), line, separator_, &cells);
    if (cells.size() != columns_.size()) {
      throw InputError(fmt::format("{}:{}: expected {} cells as there are names, found {}", file_,
                                   lines.number(), columns_.size(), cells.size()));
    }
    std::vector<double> row(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!readers[i].read(cells[chosen[i]], &row[i])) {
        const bool may_be_unit =
            table.rows.empty() && cells[chosen[i]].find_first_of("0123456789") == std::string::npos;
        const std::string hint =
            may_be_unit
                ? fmt::format("; if this is a line of units, --first-row {}", lines.number() + 1)
                : "";
        throw InputError(fmt::format("{}:{}: column '{}': '{}' is not a finite number{}", file_,
                                     lines.number(), files::one_line(columns_[chosen[i]]),
                                     files::one_line(cells[chosen[i]]), hint));
      }
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(lines.number());
  }
  if (table.rows.empty()) {
    throw InputError(fmt::format("{}: no rows below the names", file_));
  }
  return table;
}

}  // namespace flexcomp::recording
