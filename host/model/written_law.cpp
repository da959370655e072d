#include "model/written_law.hpp"

#include <algorithm>
#include <array>

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

bool is_key_of_law(const std::string& key) {
  constexpr std::array<const char*, 6> kKeys = {"effect", "place",   "joint",
                                                "axis",   "formula", "units"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

}  // namespace flexcomp::model
