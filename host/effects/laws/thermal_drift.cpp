#include <algorithm>
#include <limits>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kAluminium = 23e-6;  // 1/K, growth of the lightest material of arms

/// Rise of the temperature (K) over its first hundredth, whose mean is less noisy than one value.
Eigen::VectorXd warming(const Eigen::VectorXd& temperature) {
  const Eigen::Index first = std::max<Eigen::Index>(temperature.size() / 100, 1);
  return temperature.array() - temperature.head(first).mean();
}

Eigen::VectorXd approach(const Eigen::VectorXd& time, double constant) {
  return 1 - (-(time.array() - time[0]) / constant).exp();
}

/// How far the structure has grown at every row of a scene.
using Growth = Eigen::VectorXd (*)(const Scene&, const Values&);

Eigen::VectorXd by_temperature(const Scene& scene, const Values& /*values*/) {
  return warming(scene.temperature);
}

Eigen::VectorXd by_time(const Scene& scene, const Values& values) {
  return approach(scene.time, values[3]);
}

Law drift_law(const char* form, Growth growth, std::vector<Parameter> parameters) {
  Law law;
  law.form = form;
  law.joints = whole_machine;
  law.traits.linear_in = 3;
  law.parameters = constant(std::move(parameters));
  law.statement = says("the structure grows as it warms");
  add_term(
      [growth](const Values& values, int) {
        return Term{Term::output,
                    [=](const Scene& scene, const Simulation&, Prediction* prediction) {
                      Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
                      if (position.cols() > 0) {
                        const Eigen::VectorXd grown = growth(scene, values);
                        position += grown * Eigen::RowVector3d(values[0], values[1], values[2]);
                      }
                    }};
      },
      &law);
  return law;
}

}  // namespace

// The structure grows as it warms: the TCP moves in a fixed direction of the base frame, in
// proportion to the rise of temperature, or towards a limit with time where no temperature was
// recorded (ISO 230-3).
Forms laws::thermal_drift() {
  Law temperature =
      drift_law("temperature", by_temperature, {{"x", "m/K"}, {"y", "m/K"}, {"z", "m/K"}});
  temperature.traits.needs_temperature = true;
  const Law time =
      drift_law("time", by_time, {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"time_constant", "s"}});
  return {
      {temperature, time},
      {},
      {{"temperature", " x y z ",
        [](const Subject& of) { return within(10 * kAluminium * of.size.reach); },
        "aluminium grows by 23e-6 a kelvin; up and forward, and five times as warm as the sensor"},
       {"time", " x y z ",
        [](const Subject& of) { return within(100 * kAluminium * of.size.reach); },
        "aluminium grows by 23e-6 a kelvin; up and forward, by 50 K (ISO 230-3)"},
       {"time", " time_constant ",
        [](const Subject&) {
          return Range{60, std::numeric_limits<double>::infinity(), Rest::above};
        },
        "housings and castings warm within minutes to hours (ISO 230-3), slowly like a straight "
        "line"}}};
}

}  // namespace flexcomp::effects
