#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace flexcomp::recording {

/// Kinds of numbers that a recording has. A joint's is an angle or, of one that slides, a length;
/// what drives it is a torque or a force.
enum class Quantity { time, joint, drive, force, torque, length, temperature, line };

/// The kind of a column of a recording (host/README.md); nothing for a name that is none.
std::optional<Quantity> quantity_of(std::string_view column);

/// SI value = factor · number + offset; °C for temperatures.
struct Scale {
  double factor = 1;
  double offset = 0;
};

/// Reads `UNIT`, with `*FACTOR`, `+OFFSET` or `-OFFSET` or both after it: (factor · number +
/// offset) in that unit, as in `deg*-1-90`. No unit is SI. Units are s, ms, us, ns; rad, mrad,
/// urad, deg, turn; m, mm, um, in; N, kN, lbf; Nm, mNm, kNm, Nmm, lbfin; C, K, F; and `%`, which is
/// nothing without the factor: the value that is 100 %; its offset is SI.
///
/// Throws InputError for a unit that is unknown or none of this quantity, for a factor that is zero
/// or no number, and for an offset that is no number.
Scale scale_of(const std::string& text, Quantity quantity);

}  // namespace flexcomp::recording
