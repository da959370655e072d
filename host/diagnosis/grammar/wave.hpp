#pragma once

#include "diagnosis/grammar/driver.hpp"

namespace flexcomp::diagnosis::grammar {

/// A sinusoid over a driver.
struct Wave {
  double order = 1;  ///< 2π over its period, in the driver's unit: periods a turn of an angle
  double gain = 0;   ///< in squares, by a sine, a cosine and a constant
};

/// The wave that gains most at a seat: over an angle up to 150 periods a turn, over time up to half
/// the sampling rate (the periodogram of Lomb 1976, with weights).
Wave best_wave(const Seat& seat, const Driver& driver);

/// The same of a wave whose size is a parabola of a second driver.
Wave best_swelling_wave(const Seat& seat, const Driver& driver, const Driver& by);

/// Gain, in squares, of the best step in time.
double best_step(const Seat& seat);

}  // namespace flexcomp::diagnosis::grammar
