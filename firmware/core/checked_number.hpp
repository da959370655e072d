#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace flexcomp {

/// Is a number from outside finite and above zero?
template <typename Scalar>
bool is_positive(Scalar value) {
  return std::isfinite(value) && value > Scalar(0);
}

/// A number from outside, by its member's name, and whether it can be used.
struct CheckedMember {
  bool is_usable;
  const char* name;
};

/// The name of the first that cannot, or null.
template <std::size_t Count>
const char* first_unusable(const std::array<CheckedMember, Count>& members) {
  for (const CheckedMember& member : members) {
    if (!member.is_usable) {
      return member.name;
    }
  }
  return nullptr;
}

}  // namespace flexcomp
