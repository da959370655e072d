#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace flexcomp::model {

/// A YAML mapping that complains of what it holds with file, line and key.
class YamlMap {
 public:
  /// `where` names the mapping in messages, for example "joints.joint_a1"; empty for the document.
  /// Throws InputError if the node is no mapping or a key appears twice.
  YamlMap(const YAML::Node& node, std::string file, std::string where);

  /// Throws InputError at the first key that is none of `keys`; `why` says what is wrong with it.
  void allow_only(const std::vector<std::string>& keys,
                  const std::string& why = "unknown key") const;

  bool has(const std::string& key) const;
  std::string text(const std::string& key) const;
  YamlMap map(const std::string& key) const;
  std::vector<std::string> keys() const;

  /// A list of mappings.
  std::vector<YamlMap> maps(const std::string& key) const;

  /// A finite number.
  double number(const std::string& key) const;
  double number_or(const std::string& key, double fallback) const;

  /// A finite number that is not below zero.
  double non_negative(const std::string& key) const;
  double non_negative_or(const std::string& key, double fallback) const;

  /// A list of exactly so many finite numbers.
  template <std::size_t Count>
  std::array<double, Count> numbers(const std::string& key) const {
    std::array<double, Count> values{};
    read_numbers(key, values.data(), Count);
    return values;
  }

  /// A list of so many rows, each a list of as many finite numbers.
  Eigen::MatrixXd square(const std::string& key, Eigen::Index count) const;

  /// A list of finite numbers, however many.
  std::vector<double> list(const std::string& key) const;

  /// File, line and key, as messages begin with them.
  std::string place_of(const std::string& key) const;

  /// Throws InputError at a key's line.
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const;

 private:
  YAML::Node required(const std::string& key) const;
  void read_numbers(const std::string& key, double* values, std::size_t count) const;
  double scalar(const YAML::Node& node, const std::string& key) const;
  std::string location(const YAML::Node& node, const std::string& key) const;

  YAML::Node node_;
  std::string file_;
  std::string where_;
};

/// Parses a YAML file; throws InputError for one that is missing, unreadable, not YAML, or not one
/// mapping.
YamlMap load_yaml(const std::filesystem::path& file);

}  // namespace flexcomp::model
