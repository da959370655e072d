#include "model/yaml_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::model {

YamlMap::YamlMap(YAML::Node node, std::string file, std::string where)
    : node_(std::move(node)), file_(std::move(file)), where_(std::move(where)) {
  if (!node_.IsMap()) {
    throw InputError(fmt::format("{}: expected keys and values", location(node_, where_)));
  }
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      throw InputError(fmt::format("{}: a key must be a word", location(entry.first, where_)));
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      throw InputError(fmt::format("{}: key appears twice",
                                   location(entry.first, entry.first.Scalar())));
    }
  }
}

std::string YamlMap::location(const YAML::Node& node, const std::string& key) const {
  const YAML::Mark mark = node.Mark();
  const std::string path = where_.empty() || key == where_ ? key : where_ + "." + key;
  const std::string line = mark.is_null() ? file_ : fmt::format("{}:{}", file_, mark.line + 1);
  return path.empty() ? line : fmt::format("{}: '{}'", line, path);
}

void YamlMap::refuse(const std::string& key, const std::string& why) const {
  const YAML::Node child = node_[key];
  throw InputError(fmt::format("{}: {}", location(child.IsDefined() ? child : node_, key), why));
}

bool YamlMap::has(const std::string& key) {
  known_.insert(key);
  return static_cast<bool>(node_[key]);
}

YAML::Node YamlMap::required(const std::string& key) {
  if (!has(key)) {
    throw InputError(fmt::format("{}: missing", location(node_, key)));
  }
  return node_[key];
}

std::string YamlMap::text(const std::string& key) {
  const YAML::Node child = required(key);
  if (!child.IsScalar() || child.Scalar().empty()) {
    refuse(key, "expected a text");
  }
  return child.Scalar();
}

YamlMap YamlMap::map(const std::string& key) {
  return {required(key), file_, where_.empty() ? key : where_ + "." + key};
}

double YamlMap::scalar(const YAML::Node& node, const std::string& key) const {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    const std::string found = node.IsScalar() ? "'" + node.Scalar() + "'" : "something else";
    throw InputError(
        fmt::format("{}: expected a finite number, found {}", location(node, key), found));
  }
  return value;
}

double YamlMap::number(const std::string& key) { return scalar(required(key), key); }

double YamlMap::number_or(const std::string& key, double fallback) {
  return has(key) ? number(key) : fallback;
}

double YamlMap::positive_number(const std::string& key) {
  const double value = number(key);
  if (value < 0) {
    refuse(key, fmt::format("must not be negative, found {}", value));
  }
  return value;
}

double YamlMap::positive_number_or(const std::string& key, double fallback) {
  return has(key) ? positive_number(key) : fallback;
}

void YamlMap::read_numbers(const std::string& key, double* values, std::size_t count) {
  const YAML::Node child = required(key);
  if (!child.IsSequence() || child.size() != count) {
    refuse(key, fmt::format("expected a list of {} numbers", count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = scalar(child[i], key);
  }
}

void YamlMap::refuse_other_keys() const {
  for (const auto& entry : node_) {
    if (known_.count(entry.first.Scalar()) == 0) {
      std::string expected;
      for (const std::string& key : known_) {
        expected += (expected.empty() ? "" : ", ") + key;
      }
      throw InputError(fmt::format("{}: unknown key; known here: {}",
                                   location(entry.first, entry.first.Scalar()), expected));
    }
  }
}

YamlMap load_yaml(const std::string& file) {
  const std::string text = files::read_text(file);
  try {
    const YAML::Node document = YAML::Load(text);
    if (!document.IsMap()) {
      throw InputError(fmt::format("{}: not a YAML file with keys and values", file));
    }
    return {document, file, ""};
  } catch (const YAML::Exception& error) {
    const std::string line =
        error.mark.is_null() ? file : fmt::format("{}:{}", file, error.mark.line + 1);
    throw InputError(fmt::format("{}: not valid YAML: {}", line, error.msg));
  }
}

}  // namespace flexcomp::model
