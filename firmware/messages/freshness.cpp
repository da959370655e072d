#include "messages/freshness.hpp"

namespace flexcomp {

Freshness whole_freshness(Freshness low, unsigned bits, Freshness clock) {
  const Freshness range = Freshness{1} << bits;
  const Freshness half = range / 2;
  // How far ahead of the clock, up to half the range; else it is behind.
  const Freshness ahead = (low - clock) & (range - 1);
  return ahead < half ? clock + ahead : clock + ahead - range;
}

}  // namespace flexcomp
