#include "diagnosis/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexcomp::diagnosis {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Relative standard deviation that no samples take from a number, as by a type B evaluation (GUM,
/// JCGM 100:2008, 4.3): the law itself, and the motion's differentiation, are no more exact. An
/// engine of other makers, with the same physics and no noise to speak of, gave numbers that differ
/// by 0.1 to 1 % (tools/concealed, seed 771203).
constexpr double kLawExactness = 0.005;

/// Standard deviation of a parameter; none where it is beyond all that the parameter may be, so
/// that nothing is told.
double deviation_at(const Hypothesis& hypothesis, const Values& values,
                    const Eigen::MatrixXd& covariance, std::size_t at) {
  const auto i = static_cast<Eigen::Index>(at);
  const Parameter& parameter = hypothesis.parameters[at];
  const double deviation = std::sqrt(std::max(covariance(i, i), 0.0));
  const bool is_told = deviation > 0 && deviation < parameter.upper - parameter.lower;
  return is_told ? std::hypot(deviation, kLawExactness * values[at]) : kUnknown;
}

/// Can one of the parameters that act in proportion be told from zero? Otherwise the covariance
/// says nothing of the others, which give a shape to what may be there in any size: it comes from
/// the derivative at that size.
bool tells_the_shape(const Hypothesis& hypothesis, const Values& values,
                     const Eigen::MatrixXd& covariance) {
  if (hypothesis.linear == 0 || hypothesis.linear == values.size()) {
    return true;
  }
  for (std::size_t i = 0; i < hypothesis.linear; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (std::abs(values[i]) > kTold * std::sqrt(covariance(at, at))) {
      return true;
    }
  }
  return false;
}

/// From the waves' amplitudes a sin + b cos = amplitude · sin(… + phase), errors to first order.
void add_wave(const Values& values, const std::string& unit, const Eigen::MatrixXd& covariance,
              std::vector<Estimate>* all) {
  const double amplitude = std::hypot(values[0], values[1]);
  const Eigen::Vector2d along(values[0] / amplitude, values[1] / amplitude);
  const Eigen::Vector2d across(-values[1] / (amplitude * amplitude),
                               values[0] / (amplitude * amplitude));
  const Eigen::Matrix2d inner = covariance.topLeftCorner<2, 2>();
  all->push_back({"amplitude", unit, amplitude,
                  std::hypot(std::sqrt(along.dot(inner * along)), kLawExactness * amplitude), 0});
  all->push_back(
      {"phase", "rad", std::atan2(values[1], values[0]), std::sqrt(across.dot(inner * across)), 1});
}

}  // namespace

std::vector<Estimate> estimates(const Observations& observations, const Chosen& chosen,
                                const Eigen::MatrixXd& covariance) {
  const Hypothesis& hypothesis = chosen.hypothesis;
  const Values& values = chosen.values;
  const bool is_wave = hypothesis.traits().is_wave;
  const bool is_shape_told = tells_the_shape(hypothesis, values, covariance);
  std::vector<Estimate> all;
  if (is_wave) {
    add_wave(values, hypothesis.parameters.front().unit, covariance, &all);
  }
  for (std::size_t at = is_wave ? 2 : 0; at < values.size(); ++at) {
    const Parameter& parameter = hypothesis.parameters[at];
    if (parameter.is_of_recording) {
      continue;
    }
    const bool is_told = at < hypothesis.linear || is_shape_told;
    all.push_back({parameter.name, parameter.unit, values[at],
                   is_told ? deviation_at(hypothesis, values, covariance, at) : kUnknown, at});
  }
  if (hypothesis.law->derived) {
    const model::Robot& robot = observations.machine.robot;
    for (const effects::Derived& each : hypothesis.law->derived(robot, hypothesis.joint, values)) {
      all.push_back({each.name, each.unit, each.value,
                     deviation_at(hypothesis, values, covariance, each.parameter), each.parameter});
    }
  }
  return all;
}

Channel main_channel(const Observations& observations, const Fit& without, const Fit& with) {
  Channel best = observations.samples.front().channel;
  double most = 0;
  for (const Channel channel : observations.channels()) {
    const double noise =
        observations.rms(Eigen::VectorXd::Ones(observations.size()), channel, false);
    const double fall = observations.rms(without.remainder, channel, true) -
                        observations.rms(with.remainder, channel, true);
    if (noise > 0 && fall / noise > most) {
      most = fall / noise;
      best = channel;
    }
  }
  return best;
}

std::string place_name(const std::string& effect, int joint) {
  return joint > 0 ? fmt::format("{}, joint {}", effect, joint) : effect;
}

std::string three_digits(double value) {
  return std::abs(value) < 999.5 || std::abs(value) >= 1e6 ? fmt::format("{:.3g}", value)
                                                           : fmt::format("{:.0f}", value);
}

Scale readable_scale(double size, const std::string& unit) {
  const bool has_prefixes = unit == "m" || unit == "rad" || unit == "s";
  if (!has_prefixes || !(size > 0) || size >= 0.1) {
    return {1, unit};
  }
  return size < 1e-4 ? Scale{1e6, "µ" + unit} : Scale{1e3, "m" + unit};
}

std::string readable(double value, const std::string& unit) {
  if (unit == "1" || unit.empty()) {  // a formula may leave a unit open
    return three_digits(value);
  }
  const Scale scale = readable_scale(std::abs(value), unit);
  return three_digits(scale.factor * value) + " " + scale.unit;
}

std::string unit_of(const Observations& observations, Channel channel) {
  const std::string unit = simulation::kChannelUnits[channel];
  return channel == simulation::tcp_position
             ? unit
             : model::unit_of(observations.machine.robot.elastic, unit);
}

std::string unit_of(const Observations& observations, Channel channel, Eigen::Index component) {
  const std::string unit = simulation::kChannelUnits[channel];
  return channel == simulation::tcp_position
             ? unit
             : model::unit_of(observations.machine.robot.elastic.joint(component), unit);
}

}  // namespace flexcomp::diagnosis
