#pragma once

#include <algorithm>
#include <array>

#include "messages/messages.hpp"

/// The files beside this one say for each message what it holds. They take the classes that lcm-gen
/// makes from the .lcm files, and which break the rules of aliasing: only lcm_codec.cpp, which is
/// compiled for that, may include them.
namespace flexcomp::lcm {

/// A message as an LCM type, which also names its channel. Specialised for every message:
///
///     using Type = ...;                                        // the class that lcm-gen made
///     static void write(const Content& message, Type* type);   // but sequence and timestamp
///     static Content read(const Type& type);
template <typename Content>
struct Event;

inline std::array<double, 6> six(const double* values) {
  std::array<double, 6> copy{};
  std::copy_n(values, copy.size(), copy.begin());
  return copy;
}

}  // namespace flexcomp::lcm
