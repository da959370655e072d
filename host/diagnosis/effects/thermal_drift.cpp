#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// Rise of the temperature (K) over its first hundredth, whose mean is less noisy than one value.
Eigen::VectorXd warming(const Eigen::VectorXd& temperature) {
  const Eigen::Index first = std::max<Eigen::Index>(temperature.size() / 100, 1);
  return temperature.array() - temperature.head(first).mean();
}

Eigen::VectorXd approach(const Eigen::VectorXd& time, double constant) {
  return 1 - (-(time.array() - time[0]) / constant).exp();
}

}  // namespace

// The structure grows as it warms: the TCP moves in a fixed direction of the base frame, in
// proportion to the rise of temperature, or towards a limit with time where no temperature was
// recorded (ISO 230-3). Needs the TCP.
std::vector<Hypothesis> thermal_drift(const Observations& observations) {
  if (!observations.has(simulation::tcp_position)) {
    return {};
  }
  const Scene& first = observations.scenes.front();
  const bool by_temperature = first.temperature.size() > 0;
  const char* unit = by_temperature ? "m/K" : "m";
  const double step = by_temperature ? 1e-5 : 1e-4;
  Hypothesis hypothesis;
  hypothesis.effect = "thermal_drift";
  hypothesis.parameters = {
      {"x", unit, -0.1, 0.1, step}, {"y", unit, -0.1, 0.1, step}, {"z", unit, -0.1, 0.1, step}};
  hypothesis.form = by_temperature ? "temperature" : "time";
  hypothesis.linear = 3;
  hypothesis.statement = "the structure grows as it warms";
  if (!by_temperature) {
    constexpr double kQuickest = 60;  // s, in which anything of an arm warms
    const double duration = first.time[first.rows() - 1] - first.time[0];
    hypothesis.parameters.push_back({"time_constant", "s", 0.02 * duration,
                                     20 * std::max(duration, kQuickest), 0.05 * duration});
    hypothesis.starts.clear();
    for (const double share : {0.2, 0.4, 0.8, 1.6, 5.0}) {
      hypothesis.starts.push_back({std::max(share * duration, kQuickest)});
    }
  }
  hypothesis.apply = [by_temperature](const Values& values, Machine* machine) {
    machine->terms.push_back({simulation::Term::output,
                              [=](const Scene& scene, const Simulation&, Prediction* prediction) {
                                if (prediction->channel[simulation::tcp_position].cols() == 0) {
                                  return;
                                }
                                const Eigen::VectorXd growth =
                                    by_temperature ? warming(scene.temperature)
                                                   : approach(scene.time, values[3]);
                                prediction->channel[simulation::tcp_position] +=
                                    growth * Eigen::RowVector3d(values[0], values[1], values[2]);
                              }});
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
