#pragma once

#include <string>

#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/grammar/shape.hpp"

namespace flexcomp::diagnosis::grammar {

/// The effect of the catalogue that does what a shape of a lead does; empty where there is none.
std::string known_as(const Lead& lead, const Shape& shape);

/// The effect of the catalogue that does what a constant does beside a lead's shape, as the zero of
/// an angle or of a torque; empty where there is none.
std::string constant_as(const Lead& lead);

/// The effect of the catalogue that a lead's factor is by itself, as the direction of motion is dry
/// friction; empty where there is none.
std::string factor_as(const Material& material, const Lead& lead);

}  // namespace flexcomp::diagnosis::grammar
