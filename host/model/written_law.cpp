#include "model/written_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/yaml_map.hpp"

namespace flexcomp::model {

WrittenLaw read_written_law(const YamlMap& yaml) {
  WrittenLaw law;
  law.place = yaml.text("place");
  law.axis = yaml.has("axis") ? yaml.text("axis") : "";
  law.formula = yaml.text("formula");
  for (const char* key : {"place", "axis", "joint", "formula", "units"}) {
    law.where[key] = yaml.place_of(key);
  }
  if (yaml.has("units")) {
    const YamlMap units = yaml.map("units");
    for (const std::string& name : units.keys()) {
      law.units[name] = units.text(name);
    }
  }
  return law;
}

int read_joint_number(const YamlMap& yaml, int joints) {
  const double joint = yaml.number_or("joint", 0);
  if (yaml.has("joint") && !(joint >= 1 && joint <= joints && joint == std::floor(joint))) {
    yaml.refuse("joint", fmt::format("expected a joint, 1 to {}", joints));
  }
  return static_cast<int>(joint);
}

bool is_key_of_law(const std::string& key) {
  constexpr std::array<const char*, 6> kKeys = {"effect", "place",   "joint",
                                                "axis",   "formula", "units"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

}  // namespace flexcomp::model
