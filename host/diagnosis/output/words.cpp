#include "diagnosis/output/words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "effects/law.hpp"

namespace flexcomp::diagnosis {

std::string in_words(const std::string& effect) {
  for (const effects::Effect& each : effects::catalogue()) {
    if (each.name == effect && !each.words.empty()) {
      return each.words;
    }
  }
  std::string words = effect;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string place_in_words(const std::string& effect, int joint) {
  return joint > 0 ? fmt::format("{} of joint {}", in_words(effect), joint) : in_words(effect);
}

std::string in_words(Channel channel) {
  constexpr const char* kWords[] = {"TCP position", "joint torque", "joint deflection"};
  return kWords[channel];
}

std::string component_in_words(Channel channel, Eigen::Index component) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  return channel == simulation::tcp_position ? kAxes[component]
                                             : fmt::format("joint {}", component + 1);
}

Scale scale_of(const std::string& unit, double largest) {
  if (unit != "m" && unit != "rad") {
    return {1, unit};
  }
  constexpr double kMilli = 1e-3;
  return largest < kMilli ? Scale{1e6, "µ" + unit} : Scale{1e3, "m" + unit};
}

}  // namespace flexcomp::diagnosis
