#pragma once

#include <cstdint>
#include <limits>

namespace flexcomp {

/// Most negative raw value of a signed signal, which means "not available" (said in flexcomp.dbc).
constexpr std::int32_t not_available(int bits) { return -(std::int32_t{1} << (bits - 1)); }

/// Raw value of a signed classic signal; "not available" for NaN and what does not fit, so that
/// nothing ever wraps around.
inline std::int32_t to_raw(double value, bool (*fits)(double), std::int32_t (*encode)(double),
                           int bits) {
  return fits(value) ? encode(value) : not_available(bits);
}

/// Physical value of a signed classic signal; NaN for "not available".
inline double to_physical(std::int32_t raw, double (*decode)(std::int32_t), int bits) {
  return raw == not_available(bits) ? std::numeric_limits<double>::quiet_NaN() : decode(raw);
}

/// `raw.signal` of a generated struct, in physical units, and the other way round.
#define SIGNAL_VALUE(frame, signal, bits, raw) \
  to_physical((raw).signal, flexcomp_can_##frame##_##signal##_decode, bits)
#define SIGNAL_RAW(frame, signal, bits, value)                      \
  to_raw(value, flexcomp_can_##frame##_##signal##_is_in_phys_range, \
         flexcomp_can_##frame##_##signal##_encode, bits)

}  // namespace flexcomp
