// The samples of observations and the noise of each: of its measurement, and of its prediction.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "diagnosis/observations.hpp"
#include "recording/noise.hpp"

namespace flexcomp::diagnosis {
namespace {

using simulation::joint_deflection;
using simulation::joint_torque;
using simulation::tcp_position;

constexpr Channel kAllChannels[] = {tcp_position, joint_torque, joint_deflection};
/// Exact data still need a scale: a nanometre, a nanoradian, a millinewton-metre.
constexpr double kLeastNoise[] = {1e-9, 1e-3, 1e-9};

/// A quarter of the time, in whole stretches.
bool is_held_out(Eigen::Index row, Eigen::Index rows) { return stretch_of(row, rows) % 4 == 2; }

/// Rows over which differentiation correlates the encoders' noise.
Eigen::Index memory_of(const Scene& scene) {
  constexpr double kSmoothed = 0.035;  // s, a little more than the shortest polynomial spans
  const Eigen::Index last = scene.rows() - 1;
  const double step =
      (scene.time[last] - scene.time[0]) / static_cast<double>(std::max<Eigen::Index>(last, 1));
  return std::max<Eigen::Index>(7, static_cast<Eigen::Index>(kSmoothed / std::max(step, 1e-9)));
}

/// White noise of the measurement and what the encoders bring into the prediction, but not more
/// than the residual shows at distances at which both count.
double noise_of(const Eigen::VectorXd& difference, double prediction_noise, Eigen::Index memory) {
  const double white = recording::white_noise(difference);
  const double both = std::hypot(white, prediction_noise);
  return std::min(both, std::max(white, recording::white_noise(difference, memory)));
}

/// Share of the doubts about a prediction that a residual bears out: where they stand out of the
/// noise, the residual is as large as they are, or they are too large.
double borne_out(const Eigen::VectorXd& difference, const Eigen::VectorXd& doubt,
                 double deviation) {
  double left = 0;
  double doubted = 0;
  for (Eigen::Index row = 0; row < doubt.size(); ++row) {
    if (std::isfinite(difference[row]) && std::abs(doubt[row]) > deviation) {
      left += difference[row] * difference[row];
      doubted += doubt[row] * doubt[row];
    }
  }
  return left < doubted ? std::sqrt(left / doubted) : 1.0;
}

/// A component's difference where it says something: none of the torque of a joint that stands,
/// which may be anything that its friction holds. As noise it would count for the motion, too.
Eigen::VectorXd shown_difference(const Scene& scene, const Sample& of, Eigen::VectorXd difference) {
  if (of.channel == joint_torque && !scene.is_static) {
    difference = (scene.stands.col(of.component).array() != 0)
                     .select(std::numeric_limits<double>::quiet_NaN(), difference);
  }
  return difference;
}

}  // namespace

std::array<Eigen::MatrixXd, 3> Observations::change_with(const Scene& other, std::size_t s) const {
  simulation::Wanted wanted;
  wanted.levers = false;
  wanted.channel[tcp_position] = false;
  const Simulation with = simulate(machine, other, wanted);
  std::array<Eigen::MatrixXd, 3> change;
  for (const Channel channel : {joint_torque, joint_deflection}) {
    if (scenes[s].has(channel) && !scenes[s].is_static) {
      change[channel] =
          with.prediction.channel[channel] - simulations[s].prediction.channel[channel];
    }
  }
  return change;
}

void Observations::find_acceleration_error() {
  constexpr double kCut = 5e-3;  // of an acceleration, where a window was chosen with care
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    acceleration_error_.emplace_back();
    for (Eigen::Index joint = 0; joint < scenes[s].joints(); ++joint) {
      Scene other = scenes[s];
      other.acceleration.col(joint) *= 1 + kCut;
      acceleration_error_.back().push_back(change_with(other, s));
    }
  }
}

Eigen::MatrixXd Observations::acceleration_error() const {
  Eigen::MatrixXd error = Eigen::MatrixXd::Zero(train, machine.robot.joints());
  for (Eigen::Index i = 0; i < train; ++i) {
    const Sample& at = samples[static_cast<std::size_t>(i)];
    for (Eigen::Index joint = 0; joint < error.cols(); ++joint) {
      const Eigen::MatrixXd& change =
          acceleration_error_[at.scene][static_cast<std::size_t>(joint)][at.channel];
      error(i, joint) = change.size() > 0 ? change(at.row, at.component) / noise[i] : 0;
    }
  }
  return error;
}

PredictionNoise Observations::prediction_noise(std::size_t s) const {
  Scene noisy = scenes[s];
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  for (Eigen::Index row = 0; row < noisy.rows(); ++row) {
    for (Eigen::Index joint = 0; joint < noisy.joints(); ++joint) {
      noisy.velocity(row, joint) += noisy.velocity_noise[joint] * normal(random);
      noisy.acceleration(row, joint) += noisy.acceleration_noise[joint] * normal(random);
    }
  }
  PredictionNoise noises;
  const std::array<Eigen::MatrixXd, 3> change = change_with(noisy, s);
  for (const Channel channel : {joint_torque, joint_deflection}) {
    if (change[channel].size() > 0) {
      noises.deviation[channel] = change[channel].array().square().colwise().mean().sqrt();
    }
  }
  Scene doubtful = scenes[s];
  doubtful.acceleration += doubtful.acceleration_doubt;
  noises.doubt = change_with(doubtful, s);
  return noises;
}

void Observations::collect(std::size_t holdouts) {
  std::array<std::vector<Sample>, 2> parts;
  std::array<std::vector<double>, 2> noises;
  std::vector<PredictionNoise> of_prediction;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    of_prediction.push_back(prediction_noise(s));
  }
  for (const Channel channel : kAllChannels) {
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      for (Eigen::Index c = 0; c < scenes[s].measured[channel].cols(); ++c) {
        add_component({s, 0, channel, c}, of_prediction[s], holdouts == 0,
                      s + holdouts >= scenes.size(), &parts, &noises);
      }
    }
  }
  train = static_cast<Eigen::Index>(parts[0].size());
  train_scenes = scenes.size() - holdouts;
  samples = parts[0];
  samples.insert(samples.end(), parts[1].begin(), parts[1].end());
  noise.resize(static_cast<Eigen::Index>(samples.size()));
  noise << Eigen::Map<Eigen::VectorXd>(noises[0].data(), train),
      Eigen::Map<Eigen::VectorXd>(noises[1].data(), noise.size() - train);
  floor = noise;
}

void Observations::add_component(const Sample& first, const PredictionNoise& predicted, bool splits,
                                 bool is_holdout, std::array<std::vector<Sample>, 2>* parts,
                                 std::array<std::vector<double>, 2>* noises) {
  const auto [s, top, channel, component] = first;
  const Scene& scene = scenes[s];
  const bool is_predicted_noisily = predicted.deviation[channel].size() > 0;
  const double prediction_noise =
      is_predicted_noisily ? predicted.deviation[channel][component] : 0.0;
  const Eigen::VectorXd difference = shown_difference(
      scene, first,
      scene.measured[channel].col(component) - predictions[s].channel[channel].col(component));
  // In a load test neighbours say nothing of the noise: one unit for all until a fit tells.
  const double deviation = scene.is_static
                               ? 1e-5
                               : std::max(noise_of(difference, prediction_noise, memory_of(scene)),
                                          kLeastNoise[channel]);
  Eigen::VectorXd doubt = Eigen::VectorXd::Zero(scene.rows());
  if (is_predicted_noisily) {
    doubt = predicted.doubt[channel].col(component);
    doubt *= borne_out(difference, doubt, deviation);
  }
  for (Eigen::Index row = top; row < scene.rows(); ++row) {
    if (!std::isfinite(difference[row])) {
      continue;
    }
    if (!scene.is_static && recording::stands_alone(difference, row, deviation)) {
      ++outliers;
      continue;
    }
    const std::size_t part = splits ? is_held_out(row, scene.rows()) : is_holdout;
    (*parts)[part].push_back({s, row, channel, component});
    (*noises)[part].push_back(std::hypot(deviation, doubt[row]));
  }
}

}  // namespace flexcomp::diagnosis
