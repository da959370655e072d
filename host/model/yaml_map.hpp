#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstddef>
#include <set>
#include <string>

namespace flexcomp::model {

/// A YAML mapping that is read key by key and complains with file, line and key.
///
/// Every read marks its key as known; `refuse_other_keys` then finds the misspelt ones.
class YamlMap {
 public:
  /// `where` names the mapping in messages, for example "joints.joint_a1"; empty for the document.
  YamlMap(YAML::Node node, std::string file, std::string where);

  bool has(const std::string& key);
  std::string text(const std::string& key);
  YamlMap map(const std::string& key);

  /// A finite number, or `fallback` where the key is absent.
  double number(const std::string& key);
  double number_or(const std::string& key, double fallback);

  /// Same, and not below zero.
  double positive_number(const std::string& key);
  double positive_number_or(const std::string& key, double fallback);

  template <std::size_t Count>
  std::array<double, Count> numbers(const std::string& key) {
    std::array<double, Count> values{};
    read_numbers(key, values.data(), Count);
    return values;
  }

  void refuse_other_keys() const;

  /// Throws InputError at a key's line.
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const;

 private:
  YAML::Node required(const std::string& key);
  void read_numbers(const std::string& key, double* values, std::size_t count);
  double scalar(const YAML::Node& node, const std::string& key) const;
  std::string location(const YAML::Node& node, const std::string& key) const;

  YAML::Node node_;
  std::string file_;
  std::string where_;
  std::set<std::string> known_;
};

/// Parses a YAML file; throws InputError for one that is missing, unreadable, not YAML, or not a
/// mapping.
YamlMap load_yaml(const std::string& file);

}  // namespace flexcomp::model
