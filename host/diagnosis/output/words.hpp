#pragma once

#include <string>

#include "diagnosis/observations.hpp"

/// Names that files use for programs, as people say them.
namespace flexcomp::diagnosis {

/// "dry friction" for coulomb_friction; an effect without words of its own by its name.
std::string in_words(const std::string& effect);

/// "dry friction of joint 2".
std::string place_in_words(const std::string& effect, int joint);

/// "joint torque".
std::string in_words(Channel channel);

/// "x" of a position, "joint 3" of a torque.
std::string component_in_words(Channel channel, Eigen::Index component);

/// The unit in which values are told, by their SI unit and the largest of them: mm or µm, mrad or
/// µrad; torques and forces as they are.
struct Scale {
  double factor;
  std::string unit;
};
Scale scale_of(const std::string& unit, double largest);

}  // namespace flexcomp::diagnosis
