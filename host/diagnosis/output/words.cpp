#include "diagnosis/output/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace flexcomp::diagnosis {

std::string in_words(const std::string& effect) {
  static const std::map<std::string, std::string> kWords = {
      {"backlash", "play"},
      {"base_frame", "place of the base"},
      {"coulomb_friction", "dry friction"},
      {"friction_hysteresis", "dry friction that builds up"},
      {"gravity_compensator", "gravity compensator"},
      {"joint_axis", "direction of the axis"},
      {"joint_offset", "encoder zero"},
      {"joint_stiffness", "stiffness"},
      {"link_flexibility", "flexibility of the link"},
      {"link_length", "length of the link"},
      {"link_mass", "mass of the link"},
      {"nonlinear_stiffness", "stiffness that changes with load"},
      {"resonance", "vibration"},
      {"stribeck_friction", "friction that falls with speed"},
      {"tcp_offset", "place of the tool's tip"},
      {"time_offset", "clocks that disagree"},
      {"torque_offset", "zero of the torque"},
      {"torque_ripple", "ripple of the torque"},
      {"transmission", "coupling of the drives"},
      {"transmission_ripple", "ripple of the gear"},
      {"wrench_bias", "zero of the force sensor"},
      {"wrench_frame", "orientation of the force sensor"},
      {"wrench_scale", "gain of the force sensor"},
  };
  const auto found = kWords.find(effect);
  if (found != kWords.end()) {
    return found->second;
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
