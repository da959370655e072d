#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "byte_source.hpp"
#include "flexcomp/compensator.hpp"

namespace flexcomp::fuzz {

/// Holds the corrections of a compensator to what it promises: finite, and within value, rate and
/// acceleration limits from tick to tick.
class CorrectionWatch {
 public:
  explicit CorrectionWatch(const CompensatorConfig<float, 6>& config) : config_(config) {}

  void check(const CompensatorOutput<float, 6>& output) {
    expect(output.setpoint.allFinite(), "the setpoint is finite");
    expect(output.correction.allFinite(), "the correction is finite");
    expect(output.deflection.allFinite(), "the deflection is finite");
    for (std::size_t i = 0; i < 6; ++i) {
      check(config_.limits[i], static_cast<double>(output.correction[static_cast<Eigen::Index>(i)]),
            &joints_[i]);
    }
  }

 private:
  struct Joint {
    double correction = 0;
    double step = 0;
  };

  /// The limits times the period are rounded once each in the compensator, and so here.
  void check(const CorrectionLimits<float>& limits, double correction, Joint* joint) const {
    constexpr double kSlack = 1 + 4 * static_cast<double>(std::numeric_limits<float>::epsilon());
    const auto period = static_cast<double>(config_.period);
    const double step = correction - joint->correction;
    const double change = step - joint->step;
    expect(std::fabs(correction) <= static_cast<double>(limits.value), "the value limit");
    expect(std::fabs(step) <= kSlack * static_cast<double>(limits.rate) * period, "the rate limit");
    expect(std::fabs(change) <= kSlack * static_cast<double>(limits.acceleration) * period * period,
           "the acceleration limit");
    *joint = {correction, step};
  }

  CompensatorConfig<float, 6> config_;
  std::array<Joint, 6> joints_{};
};

}  // namespace flexcomp::fuzz
