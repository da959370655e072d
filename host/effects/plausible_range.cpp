#include "effects/plausible_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp::effects {

std::size_t Subject::index() const { return static_cast<std::size_t>(std::max(place, 1) - 1); }

double Subject::largest_load() const {
  return *std::max_element(size.load.begin(), size.load.end());
}

Range within(double size) { return {-size, size}; }

Range within(double size, double usual) {
  Range range = within(size);
  range.usual = usual;
  return range;
}

Range up_to(double most) { return {0, most, Rest::below}; }

Range change(double known, double most) { return {-known, most - known, Rest::below}; }

double over(double value, double divisor) {
  return divisor > 0 && std::isfinite(value) && std::isfinite(divisor)
             ? value / divisor
             : std::numeric_limits<double>::infinity();
}

double softest(double of_any, double most, double load) {
  return std::min(over(most, load), of_any);
}

}  // namespace flexcomp::effects
