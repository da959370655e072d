#pragma once

#include "flexcomp/types.hpp"

namespace flexcomp {

/// A robot controller's duty towards the corrections it is sent: move by them, and not by
/// itself jump when they cease, because the compensator cannot fade out what it no longer sends.
///
/// A period without a usable answer holds the last correction; after `hold_time` of them it fades
/// to zero over `fade_time` and stays there until the compensator says that it is off, from where
/// it has to be armed. A compensator that is off in the midst of a correction (it fades before it
/// turns off) has been started anew: that answer is not usable either.
class CorrectionFollower {
 public:
  using Correction = JointVector<double, 6>;

  /// Times in s.
  CorrectionFollower(double period, double hold_time, double fade_time);

  /// Takes an answer: corrected less uncorrected (rad), and whether the compensator is off or
  /// latched.
  void take(const Correction& correction, bool off);

  /// Ends a period. What the robot moves by in the next one is then in `correction`.
  void end_period();

  const Correction& correction() const { return correction_; }

  /// Have answers ceased? Until the compensator has been off.
  bool is_lost() const { return lost_; }

 private:
  double period_;
  double hold_time_;
  double fade_time_;
  Correction correction_ = Correction::Zero();
  Correction held_ = Correction::Zero();
  bool answered_ = false;
  bool lost_ = false;
  double missing_ = 0;  ///< s, since the last usable answer
};

}  // namespace flexcomp
