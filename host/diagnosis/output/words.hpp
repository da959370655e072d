#pragma once

#include <string>

#include "diagnosis/parameters.hpp"

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

/// The unit of a table or picture, by the SI unit of its values and the largest of them: mm or µm,
/// mrad or µrad; torques and forces as they are.
Scale scale_of(const std::string& unit, double largest);

}  // namespace flexcomp::diagnosis
