#pragma once

#include <Eigen/Core>

/// Physics that remembers, simulated along a recording; a signal has one value a row.
namespace flexcomp::simulation {

/// The play operator: follows `input` with a gap of twice `half_gap`, from the middle of the gap
/// on. Motion-driven backlash (Visintin 1994, "Differential models of hysteresis").
Eigen::VectorXd play(const Eigen::VectorXd& input, double half_gap);

/// Flank, −1 or 1, on which a loaded gear with play rests: it changes over when the torque (N·m)
/// has reversed and exceeds `hold`, the drag that keeps the link where it is. Torque-driven
/// backlash (Nordin and Gutman 2002, "Controlling mechanical systems with backlash", the massless
/// limit).
Eigen::VectorXd flank(const Eigen::VectorXd& torque, double hold);

/// Loop of Bouc and Wen (Wen 1976) with n = 1, β = γ = 1/2, driven by `torque`: in −1…1, from 0 on;
/// `yield`, in the torque's unit, is the integral of 1 − loop over a torque that rises from 0: how
/// much later than at once the loop is complete. Solved exactly between rows.
Eigen::VectorXd bouc_wen(const Eigen::VectorXd& torque, double yield);

/// Loop of elastic elements that slide one after another, with slip torques spread evenly up to
/// four times `yield`, which so is the same integral (Prandtl 1928, Ishlinskii 1944): in −1…1, from
/// 0 on.
Eigen::VectorXd prandtl_ishlinskii(const Eigen::VectorXd& torque, double yield);

/// Response of a mode of `frequency` (Hz) and damping ratio `damping` (below 1) with unit static
/// gain to `input`, at rest at first; exact for an input that is straight between the times (s).
Eigen::VectorXd mode(const Eigen::VectorXd& time, const Eigen::VectorXd& input, double frequency,
                     double damping);

/// Response of a mode whose natural frequency (Hz) differs from row to row; row i's holds from row
/// i − 1 to it.
Eigen::VectorXd mode(const Eigen::VectorXd& time, const Eigen::VectorXd& input,
                     const Eigen::VectorXd& frequency, double damping);

/// A signal that follows `input` by a first-order lag (s), having caught up with its slope at
/// first; exact for an input that is cubic between the times (s) (Hermite, with the slopes of
/// parabolas through three rows each).
Eigen::VectorXd lag(const Eigen::VectorXd& time, const Eigen::VectorXd& input, double constant);

/// `values` (n×m) as they were `delay` (s) before: straight between the times (s), continued beyond
/// their ends as they came there, turned about the last one.
Eigen::MatrixXd delayed(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, double delay);

/// A smooth signal (n×m) as it was `delay` (s) before: cubic between the times, as for `lag`. A
/// straight line would cut the corners of a motion: by a·dt²/8 at an acceleration a, which at 50 Hz
/// is more than the noise of a tracker.
Eigen::MatrixXd delayed_smoothly(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                                 double delay);

/// A motion (n×m) whose velocity is known, as it was `delay` (s) before: cubic between the times
/// (s) (Hermite), straight on beyond their ends.
Eigen::MatrixXd delayed_motion(const Eigen::VectorXd& time, const Eigen::MatrixXd& position,
                               const Eigen::MatrixXd& velocity, double delay);

}  // namespace flexcomp::simulation
