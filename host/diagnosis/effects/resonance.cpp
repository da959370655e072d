#include <algorithm>

#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

simulation::Term vibration(int joint, double frequency, double damping) {
  return {simulation::Term::load,
          [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            if (scene.is_static) {
              return;
            }
            const double compliance = at.joint_compliance[joint - 1];
            const auto beyond_static = [&](const Eigen::VectorXd& load) {
              return Eigen::VectorXd(simulation::mode(scene.time, load, frequency, damping) - load);
            };
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& load) {
                  return Eigen::VectorXd(compliance * beyond_static(load));
                },
                prediction);
            if (prediction->channel[simulation::joint_torque].cols() > 0) {
              add_torque(joint, -beyond_static(prediction->dynamic_load.col(joint - 1)),
                         prediction);
            }
          }};
}

/// What the whole vibration explains of a residual; less than nothing where it adds to it.
double explained(const std::vector<JointResidual>& residual, const Observations& observations,
                 int joint, double frequency, double damping, bool torque) {
  double sum = 0;
  for (std::size_t s = 0; s < residual.size(); ++s) {
    const Prediction& prediction = observations.predictions[s];
    const bool by_motion = prediction.dynamic_load.cols() > 0 &&
                           (torque || !observations.has(simulation::tcp_position));
    const Eigen::VectorXd load =
        (by_motion ? prediction.dynamic_load : prediction.load).col(joint - 1);
    const double scale = torque ? -1 : observations.simulations[s].joint_compliance[joint - 1];
    const Eigen::VectorXd wave =
        scale * (simulation::mode(observations.scenes[s].time, load, frequency, damping) - load);
    sum += 2 * wave.dot(residual[s].product) - wave.cwiseAbs2().dot(residual[s].weight);
  }
  return sum;
}

/// Frequency and damping whose vibration explains most, of a grid; the best three.
std::vector<Values> resonant_modes(const Observations& observations, int joint) {
  const Eigen::VectorXd& time = observations.scenes.front().time;
  const double rate =
      static_cast<double>(time.size() - 1) / std::max(time[time.size() - 1] - time[0], 1e-9);
  const std::vector<JointResidual> angle = observations.angle_residual(joint);
  const std::vector<JointResidual> torque = observations.torque_residual(joint);
  std::vector<std::pair<double, Values>> found;
  for (double frequency = 1.5; frequency < std::min(0.35 * rate, 120.0); frequency *= 1.03) {
    for (const double damping : {0.01, 0.04}) {
      double sum = 0;
      if (sees_angles(observations)) {
        sum += explained(angle, observations, joint, frequency, damping, false);
      }
      if (observations.has(simulation::joint_torque)) {
        sum += explained(torque, observations, joint, frequency, damping, true);
      }
      found.push_back({-sum, {frequency, damping}});
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Values> starts;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, found.size()); ++i) {
    if (found[i].first < 0) {
      starts.push_back(found[i].second);
    }
  }
  return starts;
}

}  // namespace

// A lightly damped mode of a joint's spring and what it carries: wind-up follows its load as a
// second-order system does, and the drive feels the vibrating torque (Spong 1987). Simulated along
// the load. Needs motion or changing loads, sampled several times a period.
std::vector<Hypothesis> resonance(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!!observations.is_static) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "resonance";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"frequency", "Hz", 0.5, 300, 0.1}, {"damping", "1", 1e-3, 0.5, 0.01}};
    hypothesis.linear = 0;
    hypothesis.is_sought = true;
    hypothesis.starts = resonant_modes(observations, joint);
    hypothesis.statement = fmt::format("joint {} vibrates in a lightly damped mode", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      machine->terms.push_back(vibration(joint, values[0], values[1]));
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
