#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

const char* clock_name(Channel channel) {
  return channel == simulation::tcp_position   ? "TCP measurement"
         : channel == simulation::joint_torque ? "torques"
                                               : "link encoders";
}

simulation::Term late_channel(Channel channel, double delay) {
  return {simulation::Term::clock,
          [=](const Scene& scene, const Simulation&, Prediction* prediction) {
            Eigen::MatrixXd& values = prediction->channel[channel];
            if (values.cols() > 0 && !scene.is_static) {
              values = simulation::delayed(scene.time, values, delay);
              if (channel == simulation::joint_deflection) {
                // Of late link encoders, the whole angle is late, not the wind-up alone.
                values += simulation::moved_before(scene.time, scene.q, scene.velocity, delay);
              }
            }
          }};
}

simulation::Term late_wrench(double delay) {
  return {simulation::Term::wrench,
          [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
            if (!scene.is_static) {
              add_wrench(at, simulation::delayed(scene.time, at.wrench, -delay) - at.wrench,
                         prediction);
            }
          }};
}

}  // namespace

// Two clocks of the recording disagree: a group of columns belongs to an earlier time than the
// joint angles beside it. Needs motion or, for the wrench, a changing load.
std::vector<Hypothesis> time_offset(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (observations.is_static) {
    return all;
  }
  std::vector<Values> guesses;
  for (double delay = 1e-3; delay < 0.1; delay *= 1.35) {
    guesses.push_back({delay});
    guesses.push_back({-delay});
  }
  Hypothesis hypothesis;
  hypothesis.effect = "time_offset";
  hypothesis.parameters = {{"delay", "s", -0.5, 0.5, 1e-3}};
  hypothesis.linear = 1;
  for (const Channel channel :
       {simulation::tcp_position, simulation::joint_torque, simulation::joint_deflection}) {
    if (observations.has(channel)) {
      hypothesis.statement = fmt::format(
          "the clock of the {} disagrees with that of the joint angles", clock_name(channel));
      hypothesis.form = simulation::kChannels[channel];
      // Friction turns with the motion: a late torque is far from proportion to its delay.
      const bool jumps = channel == simulation::joint_torque;
      hypothesis.linear = jumps ? 0 : 1;
      hypothesis.starts = jumps ? guesses : std::vector<Values>{{}};
      hypothesis.apply = [channel](const Values& values, Machine* machine) {
        machine->terms.push_back(late_channel(channel, values[0]));
      };
      all.push_back(hypothesis);
    }
  }
  if (observations.has_wrench()) {
    hypothesis.statement = "the clock of the force sensor disagrees with that of the joint angles";
    hypothesis.form = "wrench";
    hypothesis.linear = 0;
    hypothesis.starts = guesses;
    hypothesis.alters_model = true;
    hypothesis.apply = [](const Values& values, Machine* machine) {
      machine->wrench_delay += values[0];
    };
    hypothesis.sketch = [](const Values& values) { return late_wrench(values[0]); };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
