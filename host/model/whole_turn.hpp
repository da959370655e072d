#pragma once

#include <cmath>

namespace flexcomp::model {

/// Is an angle (rad) of an orientation more than a whole turn? Nobody writes one so: it is in
/// degrees.
inline bool is_beyond_a_turn(double angle) {
  constexpr double kWholeTurn = 6.283185307179586;
  constexpr double kRounding = 1.001;
  return std::abs(angle) > kRounding * kWholeTurn;
}

}  // namespace flexcomp::model
