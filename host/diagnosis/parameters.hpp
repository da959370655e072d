#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A parameter as it is reported.
struct Estimate {
  std::string name;
  std::string unit;
  double value = 0;
  double deviation = 0;       ///< standard; NaN where the fit does not tell
  std::size_t parameter = 0;  ///< index of the one that it is, or follows from
};

/// Parameters of a hypothesis with their covariance, and those that follow from them: amplitude and
/// phase of a ripple, a spring's whole compliance, a sensor's gain.
std::vector<Estimate> estimates(const Observations& observations, const Chosen& chosen,
                                const Eigen::MatrixXd& covariance);

/// The channel in which a finding lowers the held-out error most, over the noise.
Channel main_channel(const Observations& observations, const Fit& without, const Fit& with);

/// "joint_stiffness, joint 2"
std::string place_name(const std::string& effect, int joint);

/// Standard deviations on either side that hold 95 % of a normal distribution: an estimate nearer
/// to zero may be zero.
constexpr double kTold = 1.96;

/// Three digits, but tens and thousands written out: 0.0123, 1214.
std::string three_digits(double value);

/// A unit with its prefix, and how many of it are one of the SI unit.
struct Scale {
  double factor;
  std::string unit;
};

/// The prefix with which a value of this size is easy to read; none where people write none.
Scale readable_scale(double size, const std::string& unit);

/// A value with its unit as people write it: 0.21 mrad, 14 µm.
std::string readable(double value, const std::string& unit);

/// SI unit of a channel: m, N·m, rad; N and m where all joints slide, both where some do.
std::string unit_of(const Observations& observations, Channel channel);

/// The same of one component: an axis, or a joint.
std::string unit_of(const Observations& observations, Channel channel, Eigen::Index component);

}  // namespace flexcomp::diagnosis
