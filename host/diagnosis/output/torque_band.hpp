#pragma once

#include <Eigen/Core>
#include <optional>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// The band of torques that recorded angles can tell anything of.
///
/// Simulated torques come from angles that were differentiated by polynomials over a window of
/// time, which pass what is slow. Measured torques hold faster parts too: ripple of a current loop,
/// noise. As identification does, an error is told once more with both passed through the same
/// polynomials.
struct TorqueBand {
  double half_window = 0;  ///< s, of the polynomials
  double frequency = 0;    ///< Hz, at which they pass half of the power
};

/// None where no torque was measured in motion, or where windows hold so few samples that whatever
/// these can show passes.
std::optional<TorqueBand> torque_band(const Observations& observations);

/// Root mean square (N·m) of joint torques, given over their noise, within the band: of the samples
/// to fit to, or of those held out.
double rms_in_band(const Observations& observations, const TorqueBand& band,
                   const Eigen::VectorXd& values, bool held_out);

}  // namespace flexcomp::diagnosis
