#pragma once

#include "flexcomp/types.hpp"

namespace flexcomp::control {

/// What stands between a change of the wrench and the robot's answer to it.
struct CorrectionLoop {
  double period = 0.004;     ///< s, from one tick to the next
  double filter_cutoff = 0;  ///< Hz, of the compensator's low-pass on the wrench; 0: none
  double delay = 0.004;      ///< s, from the wrench to the robot standing corrected; whole periods
};

/// How strongly a cut answers itself at one posture: λ = n·C w / a, the displacement into the
/// material that the nominal wrench w causes, over the depth of cut a; n is the surface normal into
/// the material, C the compliance at the TCP (base frame).
///
/// In milling the force is proportional to the area of the chip (Altintas, Manufacturing
/// Automation, ch. 2): a tool that stands deeper by δ sees w (1 + δ/a), which moves it by λ δ more.
/// Below zero the wrench pushes the tool out of the cut; at one it digs in by itself.
double cut_feedback(const Compliance<double>& compliance, const Wrench<double>& wrench,
                    const Vector3<double>& normal, double depth_of_cut);

/// Largest correction gain in [0, 1] at which the loop through the process is stable with a gain
/// margin of `margin` (2: 6 dB); 0 if the process digs in without any correction.
///
/// The loop: force e w with e = 1 + δ/a, displacement δ = λ a (1 − g H(z)) e, H the delay and the
/// low-pass. It is closed by L(z) = g λ/(1−λ) H(z); the open loop is stable, so the smallest g at
/// which L(e^(jω)) passes through −1 is the limit (Nyquist).
double largest_safe_gain(double feedback, const CorrectionLoop& loop, double margin = 2);

/// Smallest gain at which 1 + gain × factor × H(z) has a root on the unit circle, `factor` being
/// λ/(1−λ); infinity for a factor of zero.
double critical_gain(double factor, const CorrectionLoop& loop);

}  // namespace flexcomp::control
