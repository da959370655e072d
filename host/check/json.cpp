#include "check/json.hpp"

namespace flexcomp::check {

nlohmann::ordered_json as_json(const Checks& checks) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Check& each : checks) {
    list.push_back({{"severity", word(each.severity)},
                    {"about", each.about},
                    {"name", each.name},
                    {"what", each.what},
                    {"fix", each.fix}});
  }
  return list;
}

}  // namespace flexcomp::check
