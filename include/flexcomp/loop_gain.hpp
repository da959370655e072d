#pragma once

/// @file
/// The largest gain at which correcting from a measured force is stable.

#include "flexcomp/table.hpp"

namespace flexcomp {

/// The path from a change of the wrench to the robot's answer.
struct CorrectionLoop {
  double period = 0.004;     ///< s, from one tick to the next
  double filter_cutoff = 0;  ///< Hz, of the compensator's low-pass on the wrench; 0: none
  double delay = 0.004;      ///< s, from the wrench to the robot standing corrected; whole periods
};

/// Range along a program of the feedback λ = n·C w / a of a cut: the displacement into the material
/// (n: surface normal, C: compliance at the TCP) under the nominal wrench w, over the depth of cut
/// a. Below zero the wrench pushes the tool out of the cut; at one the tool digs in by itself.
struct FeedbackRange {
  double least = 0;  ///< zero or below
  double most = 0;   ///< zero or above

  /// Widens the range to hold a value.
  void include(double feedback) {
    least = feedback < least ? feedback : least;
    most = feedback > most ? feedback : most;
  }
};

/// How far a correction may go along a program.
struct GainLimit {
  double stable = 0;  ///< gain at which the loop begins to be unstable somewhere; may be infinite
  double safe = 0;    ///< largest gain, at most one, with a margin of two; never zero (see below)
  /// How many times as deep as nominal the cut becomes: with the safe gain, and should the
  /// correction fade out, as it must on any fault. Infinite where the tool digs in by itself.
  double engagement = 1;
  double engagement_without = 1;  ///< the second of the two

  /// Does the tool dig in, or does no stable gain keep the cut from becoming twice as deep?
  bool digs_in() const { return !(engagement <= kMargin); }

  static constexpr double kMargin = 2;  ///< of the gain (6 dB, as usual for loops) and the depth
  /// Stands for none: zero in a table means "not analysed".
  static constexpr double kNone = 1e-6;
};

/// Smallest gain at which 1 + gain × factor × H(z) has a root on the unit circle, H being the delay
/// and the low-pass, `factor` λ/(1−λ); infinity for a factor of zero.
double critical_gain(double factor, const CorrectionLoop& loop);

/// The limit where λ has a range. With a gain g the cut becomes 1/(1 − λ (1 − g)) times as deep.
/// `softer`: the robot's compliances over those that the correction is computed with.
GainLimit gain_limit(const FeedbackRange& range, const CorrectionLoop& loop, double softer = 1);

/// The limit that a table's statement leads to; its depth of cut and period are above zero.
GainLimit gain_limit(const GainBasis& basis);

/// Are there no numbers in a statement?
bool is_empty(const GainBasis& basis);

/// Does a largest gain follow from the statement beside it? Any does where there is none, and none
/// does where the numbers are such as no process or controller has.
bool follows_from(double largest_gain, const GainBasis& basis);

}  // namespace flexcomp
