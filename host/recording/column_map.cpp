#include "recording/column_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

#include "error.hpp"
#include "files/one_line.hpp"
#include "model/chain.hpp"
#include "recording/foreign_units.hpp"

namespace flexcomp::recording {
namespace {

constexpr std::size_t kLongestMessage = 400;

/// One column of a recording, and where its numbers come from.
struct Source {
  std::string target;
  std::size_t column;  ///< of the table
  Scale scale;
};

[[noreturn]] void refuse(const std::string& rule, const std::string& why) {
  throw InputError(fmt::format("--map {}: {}", files::one_line(rule), why));
}

std::string listed(const std::vector<std::string>& names) {
  return files::one_line(fmt::format("{}", fmt::join(names, ", ")), kLongestMessage);
}

/// Is the line that should name the columns a row of numbers?
bool are_numbers(const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [](const std::string& name) {
    double number = 0;
    const char* end = name.data() + name.size();
    const auto [read, error] = std::from_chars(name.data(), end, number);
    return error == std::errc{} && read == end;
  });
}

std::string with_number(std::string name, int number) {
  const std::size_t star = name.find('*');
  return star == std::string::npos ? name : name.replace(star, 1, std::to_string(number));
}

/// Number of the joint that a column is about; 0 for other columns.
int joint_of(const std::string& target) {
  const std::optional<Quantity> quantity = quantity_of(target);
  if (quantity != Quantity::joint && quantity != Quantity::drive) {
    return 0;
  }
  constexpr std::size_t kDigits = 4;
  return std::stoi(target.substr(target.rfind('_') + 1, kDigits));
}

/// Rules applied to the names of a table.
class Resolver {
 public:
  explicit Resolver(const ForeignTable& table) : table_(table) {}

  void add(const std::string& rule) {
    const std::size_t equals = rule.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == rule.size()) {
      refuse(rule, "expected COLUMN=NAME or COLUMN=NAME:UNIT");
    }
    const std::string target = rule.substr(0, equals);
    const std::string source = rule.substr(equals + 1);
    const bool counts = target.find('*') != std::string::npos;
    if (counts != (source.find('*') < source.rfind(':'))) {
      refuse(rule, "expected * for the joint's number on both sides, or on none");
    }
    if (counts) {
      add_joints(rule, target, source);
    } else {
      add_one(rule, target, source);
    }
  }

  /// From here on rules with * leave out the columns that have a rule.
  void keep_single_rules() { single_ = sources_.size(); }

  const std::vector<Source>& sources() const { return sources_; }

 private:
  struct Name {
    std::size_t column;
    std::string unit;
  };

  /// A name may have a colon itself, so that the whole is looked for first.
  std::optional<Name> find(const std::string& source) const {
    const std::size_t colon = source.rfind(':');
    const auto index = [this](const std::string& name) {
      return std::find(table_.columns().begin(), table_.columns().end(), name);
    };
    const auto end = table_.columns().end();
    if (const auto whole = index(source); whole != end) {
      return Name{static_cast<std::size_t>(whole - table_.columns().begin()), ""};
    }
    const auto named = index(source.substr(0, colon));
    if (colon == std::string::npos || named == end) {
      return std::nullopt;
    }
    return Name{static_cast<std::size_t>(named - table_.columns().begin()),
                source.substr(colon + 1)};
  }

  void add_joints(const std::string& rule, const std::string& target, const std::string& source) {
    const int first = find(with_number(source, 0)) ? 0 : 1;
    int joint = 0;
    while (joint < model::kMostJoints && find(with_number(source, first + joint))) {
      ++joint;
      const std::string own = with_number(target, joint);
      const auto end = sources_.begin() + static_cast<std::ptrdiff_t>(single_);
      if (std::none_of(sources_.begin(), end,
                       [&](const Source& each) { return each.target == own; })) {
        add_one(rule, own, with_number(source, first + joint - 1));
      }
    }
    if (joint == 0) {
      add_one(rule, with_number(target, 1), with_number(source, 1));  // it says what is missing
    }
  }

  void add_one(const std::string& rule, const std::string& target, const std::string& source) {
    const std::optional<Quantity> quantity = quantity_of(target);
    if (!quantity) {
      refuse(rule, fmt::format("'{}' is no column of a recording; expected t, q_cmd_1, q_meas_1, "
                               "q_link_1, tau_1, fx to mz, x, y, z, temp_c or line",
                               files::one_line(target)));
    }
    if (joint_of(target) > model::kMostJoints) {
      refuse(rule, fmt::format("a robot has at most {} joints", model::kMostJoints));
    }
    const std::optional<Name> name = find(source);
    if (!name) {
      refuse(rule, fmt::format("{} has no column '{}'; it has {}{}", table_.file(),
                               files::one_line(source), listed(table_.columns()),
                               are_numbers(table_.columns())
                                   ? "; where no line names the columns, give --names"
                                   : ""));
    }
    refuse_what_is_double(rule, target, *name);
    try {
      sources_.push_back({target, name->column, scale_of(name->unit, *quantity)});
    } catch (const InputError& error) {
      refuse(rule, error.what());
    }
  }

  void refuse_what_is_double(const std::string& rule, const std::string& target,
                             const Name& name) const {
    const std::string& column = table_.columns()[name.column];
    if (std::count(table_.columns().begin(), table_.columns().end(), column) > 1) {
      refuse(rule, fmt::format("{} has more than one column '{}'", table_.file(),
                               files::one_line(column)));
    }
    for (const Source& source : sources_) {
      if (source.target == target && target != "t") {
        refuse(rule, fmt::format("column '{}' has a rule already", target));
      }
    }
  }

  const ForeignTable& table_;
  std::vector<Source> sources_;
  std::size_t single_ = 0;  ///< so many of them are of rules without *
};

int joints_of(const std::vector<Source>& sources) {
  int joints = 1;
  for (const Source& source : sources) {
    joints = std::max(joints, joint_of(source.target));
  }
  return joints;
}

/// A number that was finite and is none any more in SI units is a slip of a unit or factor.
void refuse_infinity(const NumberTable& table, const std::string& column, std::size_t row,
                     double value) {
  if (std::isinf(value)) {
    throw InputError(fmt::format("{}:{}: column '{}' is beyond all numbers in its unit", table.file,
                                 table.line(row), column));
  }
}

/// The table with a recording's columns and units.
NumberTable converted(const NumberTable& raw, const std::vector<Source>& sources) {
  NumberTable table;
  table.file = raw.file;
  table.lines = raw.lines;
  std::vector<std::size_t> places;
  for (const Source& source : sources) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), source.target);
    places.push_back(static_cast<std::size_t>(found - table.columns.begin()));
    if (found == table.columns.end()) {
      table.columns.push_back(source.target);
    }
  }
  for (const std::vector<double>& numbers : raw.rows) {
    std::vector<double> row(table.columns.size(), 0);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const double start = sources[i].target == "t" ? raw.rows.front()[i] : 0;
      row[places[i]] += sources[i].scale.factor * (numbers[i] - start) + sources[i].scale.offset;
      refuse_infinity(raw, sources[i].target, table.rows.size(), row[places[i]]);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Mapped map_columns(const ForeignTable& table, const std::vector<std::string>& rules) {
  Resolver resolver(table);
  const auto counts = [](const std::string& rule) { return rule.find('*') < rule.find('='); };
  for (const std::string& rule : rules) {
    if (!counts(rule)) {
      resolver.add(rule);
    }
  }
  resolver.keep_single_rules();
  for (const std::string& rule : rules) {
    if (counts(rule)) {
      resolver.add(rule);
    }
  }
  std::vector<std::size_t> chosen;
  for (const Source& source : resolver.sources()) {
    chosen.push_back(source.column);
  }
  Mapped mapped;
  for (std::size_t column = 0; column < table.columns().size(); ++column) {
    if (std::find(chosen.begin(), chosen.end(), column) == chosen.end() &&
        !table.columns()[column].empty()) {
      mapped.left_out.push_back(table.columns()[column]);
    }
  }
  mapped.recording = recording_of(converted(table.numbers(chosen), resolver.sources()),
                                  joints_of(resolver.sources()));
  return mapped;
}

}  // namespace flexcomp::recording
