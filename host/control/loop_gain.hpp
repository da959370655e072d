#pragma once

#include <Eigen/Core>
#include <complex>

#include "flexcomp/types.hpp"

namespace flexcomp::control {

/// What stands between a change of the wrench and the robot's answer to it.
struct CorrectionLoop {
  double period = 0.004;     ///< s, from one tick to the next
  double filter_cutoff = 0;  ///< Hz, of the compensator's low-pass on the wrench; 0: none
  double delay = 0.004;      ///< s, from the wrench to the robot standing corrected; whole periods
};

/// How a process answers displacement: `stiffness` is the change of the wrench (N, N·m) for a
/// translation (m) or rotation (rad) of the TCP, base frame.
///
/// In milling, a tool that stands deeper by δ along the normal n of the surface sees its wrench
/// grow from w by w δ/a, with a the depth of cut (force proportional to chip area; Altintas,
/// Manufacturing Automation, ch. 2): stiffness = w nᵀ / a.
Compliance<double> milling_stiffness(const Wrench<double>& wrench, const Vector3<double>& normal,
                                     double depth_of_cut);

/// Largest correction gain in [0, 1] at which the loop through the process is stable with a gain
/// margin of `margin` (2: 6 dB), at one posture.
///
/// The loop: w = w₀ + K x, x = C w − g H C w with H = z^(−delay) × low-pass. For each eigenvalue λ
/// of K C it is closed by L(z) = g λ/(1−λ) H(z); the open loop is stable, so the smallest g at
/// which L(e^(jω)) passes through −1 is the limit (Nyquist). An eigenvalue with real part of 1 or
/// more means that the process digs in by itself, without any correction: 0.
double largest_safe_gain(const Compliance<double>& compliance, const Compliance<double>& stiffness,
                         const CorrectionLoop& loop, double margin = 2);

/// Smallest gain at which 1 + gain × factor × H(z) has a root on the unit circle, `factor` being
/// λ/(1−λ); infinity if there is none.
double critical_gain(std::complex<double> factor, const CorrectionLoop& loop);

}  // namespace flexcomp::control
