#include "diagnosis/output/torque_band.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "simulation/differentiation.hpp"

namespace flexcomp::diagnosis {
namespace {

/// One joint's torques over time, in a recording.
struct Series {
  std::vector<double> time;   ///< s, rising
  std::vector<double> value;  ///< N·m
};

std::vector<Series> torques_of(const Observations& observations, const Eigen::VectorXd& values,
                               bool held_out) {
  std::map<std::pair<std::size_t, Eigen::Index>, Series> series;
  const Part part = observations.part(held_out);
  for (Eigen::Index i = part.first; i < part.end; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const Scene& scene = observations.scenes[at.scene];
    if (at.channel == simulation::joint_torque && !scene.is_static) {
      Series& own = series[{at.scene, at.component}];
      own.time.push_back(scene.time[at.row]);
      own.value.push_back(values[i] * observations.noise[i]);
    }
  }
  std::vector<Series> all;
  for (auto& [place, own] : series) {
    all.push_back(std::move(own));
  }
  return all;
}

/// Does a scene's window hold so many samples that polynomials through them are smoother? Through
/// few they pass whatever the samples hold.
bool window_smooths(const Scene& scene) {
  constexpr double kTwice = 2;  // samples for each coefficient
  const double duration = scene.time[scene.rows() - 1] - scene.time[0];
  const double in_window = 2 * scene.half_window * static_cast<double>(scene.rows()) / duration;
  return in_window > kTwice * (simulation::kPolynomialOrder + 1);
}

}  // namespace

std::optional<TorqueBand> torque_band(const Observations& observations) {
  TorqueBand band;
  bool smooths = false;
  for (const Scene& scene : observations.scenes) {
    if (scene.has(simulation::joint_torque) && !scene.is_static) {
      band.half_window = std::max(band.half_window, scene.half_window);
      smooths = smooths || window_smooths(scene);
    }
  }
  if (!smooths) {
    return std::nullopt;
  }
  band.frequency = simulation::half_power_frequency(band.half_window);
  return band;
}

double rms_in_band(const Observations& observations, const TorqueBand& band,
                   const Eigen::VectorXd& values, bool held_out) {
  double sum = 0;
  double count = 0;
  for (const Series& series : torques_of(observations, values, held_out)) {
    const auto size = static_cast<Eigen::Index>(series.time.size());
    const Eigen::VectorXd smooth = simulation::smoothed(
        Eigen::Map<const Eigen::VectorXd>(series.time.data(), size),
        Eigen::Map<const Eigen::VectorXd>(series.value.data(), size), band.half_window);
    sum += smooth.squaredNorm();
    count += static_cast<double>(size);
  }
  return std::sqrt(sum / count);
}

}  // namespace flexcomp::diagnosis
