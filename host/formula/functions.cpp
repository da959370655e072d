#include "formula/functions.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::formula {

const std::array<Function, 17> kFunctions = {{
    {"lag", 2, FunctionUnits::lag, nullptr},
    {"play", 2, FunctionUnits::same, nullptr},
    {"sin", 1, FunctionUnits::of_angle, [](double x, double) { return std::sin(x); }},
    {"cos", 1, FunctionUnits::of_angle, [](double x, double) { return std::cos(x); }},
    {"tan", 1, FunctionUnits::of_angle, [](double x, double) { return std::tan(x); }},
    {"asin", 1, FunctionUnits::of_number, [](double x, double) { return std::asin(x); }},
    {"acos", 1, FunctionUnits::of_number, [](double x, double) { return std::acos(x); }},
    {"atan", 1, FunctionUnits::of_number, [](double x, double) { return std::atan(x); }},
    {"tanh", 1, FunctionUnits::of_number, [](double x, double) { return std::tanh(x); }},
    {"exp", 1, FunctionUnits::of_number, [](double x, double) { return std::exp(x); }},
    {"log", 1, FunctionUnits::of_number, [](double x, double) { return std::log(x); }},
    {"sqrt", 1, FunctionUnits::root, [](double x, double) { return std::sqrt(x); }},
    {"abs", 1, FunctionUnits::same, [](double x, double) { return std::abs(x); }},
    {"sign", 1, FunctionUnits::sign,
     [](double x, double) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0); }},
    {"step", 1, FunctionUnits::sign, [](double x, double) { return x > 0 ? 1.0 : 0.0; }},
    {"min", 2, FunctionUnits::same, [](double x, double y) { return std::min(x, y); }},
    {"max", 2, FunctionUnits::same, [](double x, double y) { return std::max(x, y); }},
}};

}  // namespace flexcomp::formula
