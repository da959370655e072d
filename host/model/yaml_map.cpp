#include "model/yaml_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "error.hpp"
#include "files/one_line.hpp"
#include "model/edit_distance.hpp"
#include "model/yaml_document.hpp"

namespace flexcomp::model {
namespace {

std::string description(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return "'" + files::one_line(node.Scalar()) + "'";
    case YAML::NodeType::Sequence:
      return fmt::format("a list of {}", node.size());
    case YAML::NodeType::Map:
      return "keys and values";
    default:
      return "nothing";
  }
}

/// "did you mean" for a slip of the pen that is near to one key alone, else all there are.
std::string expectation(const std::string& found, const std::vector<std::string>& keys) {
  std::multimap<std::size_t, std::string> by_distance;
  for (const std::string& key : keys) {
    by_distance.emplace(edit_distance(found, key), key);
  }
  const auto [distance, nearest] = *by_distance.begin();
  if (by_distance.count(distance) == 1 && 2 * distance <= nearest.size()) {
    return fmt::format("did you mean '{}'?", files::one_line(nearest));
  }
  return fmt::format("expected one of: {}",
                     files::one_line(fmt::format("{}", fmt::join(keys, ", ")), 300));
}

}  // namespace

YamlMap::YamlMap(const YAML::Node& node, std::string file, std::string where)
    : node_(node), file_(std::move(file)), where_(std::move(where)) {
  if (!node_.IsMap()) {
    throw InputError(fmt::format("{}: expected keys and values, found {}", location(node_, where_),
                                 description(node_)));
  }
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      throw InputError(fmt::format("{}: expected a word as key, found {}",
                                   location(entry.first, where_), description(entry.first)));
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      throw InputError(
          fmt::format("{}: the key appears twice", location(entry.first, entry.first.Scalar())));
    }
  }
}

std::string YamlMap::location(const YAML::Node& node, const std::string& key) const {
  const std::string path = where_.empty() || key == where_ ? key : where_ + "." + key;
  const YAML::Mark mark = node.Mark();
  const std::string line = mark.is_null() ? file_ : fmt::format("{}:{}", file_, mark.line + 1);
  return path.empty() ? line : fmt::format("{}: '{}'", line, files::one_line(path));
}

std::string YamlMap::place_of(const std::string& key) const {
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) {
      return location(entry.first, key);
    }
  }
  return location(node_, key);
}

void YamlMap::refuse(const std::string& key, const std::string& why) const {
  throw InputError(fmt::format("{}: {}", place_of(key), why));
}

void YamlMap::allow_only(const std::vector<std::string>& keys, const std::string& why) const {
  for (const auto& entry : node_) {
    const std::string& found = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), found) == keys.end()) {
      throw InputError(
          fmt::format("{}: {}; {}", location(entry.first, found), why, expectation(found, keys)));
    }
  }
}

bool YamlMap::has(const std::string& key) const { return node_[key].IsDefined(); }

YAML::Node YamlMap::required(const std::string& key) const {
  if (!has(key)) {
    refuse(key, "missing");
  }
  return node_[key];
}

std::string YamlMap::text(const std::string& key) const {
  const YAML::Node child = required(key);
  if (!child.IsScalar() || child.Scalar().empty()) {
    refuse(key, fmt::format("expected a text, found {}", description(child)));
  }
  return child.Scalar();
}

YamlMap YamlMap::map(const std::string& key) const {
  const YAML::Node child = required(key);
  if (!child.IsMap()) {
    refuse(key, fmt::format("expected keys and values, found {}", description(child)));
  }
  return {child, file_, where_.empty() ? key : where_ + "." + key};
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> all;
  for (const auto& entry : node_) {
    all.push_back(entry.first.Scalar());
  }
  return all;
}

std::vector<YamlMap> YamlMap::maps(const std::string& key) const {
  const YAML::Node list = required(key);
  if (!list.IsSequence()) {
    refuse(key, fmt::format("expected a list, found {}", description(list)));
  }
  std::vector<YamlMap> all;
  for (std::size_t i = 0; i < list.size(); ++i) {
    all.emplace_back(list[i], file_, fmt::format("{}[{}]", key, i));
  }
  return all;
}

double YamlMap::scalar(const YAML::Node& node, const std::string& key) const {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    refuse(key, fmt::format("expected a finite number, found {}", description(node)));
  }
  return value;
}

double YamlMap::number(const std::string& key) const { return scalar(required(key), key); }

double YamlMap::number_or(const std::string& key, double fallback) const {
  return has(key) ? number(key) : fallback;
}

double YamlMap::non_negative(const std::string& key) const {
  const double value = number(key);
  if (value < 0) {
    refuse(key, fmt::format("must not be negative, found {}", value));
  }
  return value;
}

double YamlMap::non_negative_or(const std::string& key, double fallback) const {
  return has(key) ? non_negative(key) : fallback;
}

Eigen::MatrixXd YamlMap::square(const std::string& key, Eigen::Index count) const {
  const YAML::Node rows = required(key);
  const auto size = static_cast<std::size_t>(count);
  if (!rows.IsSequence() || rows.size() != size) {
    refuse(key, fmt::format("expected a list of {} rows, found {}", count, description(rows)));
  }
  Eigen::MatrixXd values(count, count);
  for (std::size_t row = 0; row < size; ++row) {
    if (!rows[row].IsSequence() || rows[row].size() != size) {
      refuse(key,
             fmt::format("expected rows of {} numbers, found {}", count, description(rows[row])));
    }
    for (std::size_t column = 0; column < size; ++column) {
      values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          scalar(rows[row][column], key);
    }
  }
  return values;
}

void YamlMap::read_numbers(const std::string& key, double* values, std::size_t count) const {
  const YAML::Node child = required(key);
  if (!child.IsSequence() || child.size() != count) {
    refuse(key, fmt::format("expected a list of {} numbers, found {}", count, description(child)));
  }
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = scalar(child[i], key);
  }
}

std::vector<double> YamlMap::list(const std::string& key) const {
  const YAML::Node child = required(key);
  if (!child.IsSequence()) {
    refuse(key, fmt::format("expected a list of numbers, found {}", description(child)));
  }
  std::vector<double> values(child.size());
  read_numbers(key, values.data(), values.size());
  return values;
}

YamlMap load_yaml(const std::filesystem::path& file) {
  return {read_yaml(file), file.string(), ""};
}

}  // namespace flexcomp::model
