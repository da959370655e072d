#pragma once

#include <map>
#include <string>

namespace flexcomp::model {

class YamlMap;

/// The effect's name of physics that a formula says.
constexpr const char* kLaw = "law";

/// Physics written as a formula, as it stands in a file; effects/formula_law.hpp says what it
/// means.
struct WrittenLaw {
  std::string place;                         ///< where it acts, such as joint_torque
  std::string axis;                          ///< x, y, z, …; empty where the place has none
  std::string formula;                       ///< its value there, SI
  std::map<std::string, std::string> units;  ///< of parameters, by name, as far as they are given
  /// File, line and key of `place`, `axis`, `joint`, `formula` and `units`, for messages.
  std::map<std::string, std::string> where;
};

/// Reads the keys `place`, `axis`, `formula` and `units` of a map. Throws InputError for one that
/// is missing or no text.
WrittenLaw read_written_law(const YamlMap& yaml);

/// Reads the key `joint`: from 1 on, 0 without the key. Throws InputError for a joint that a robot
/// of so many joints does not have.
int read_joint_number(const YamlMap& yaml, int joints);

/// Is a key part of how a law is written, or else one of its parameters?
bool is_key_of_law(const std::string& key);

}  // namespace flexcomp::model
