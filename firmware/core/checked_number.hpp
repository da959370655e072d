#pragma once

#include <cmath>

namespace flexcomp {

/// Is a number from outside finite and above zero?
template <typename Scalar>
bool is_positive(Scalar value) {
  return std::isfinite(value) && value > Scalar(0);
}

}  // namespace flexcomp
