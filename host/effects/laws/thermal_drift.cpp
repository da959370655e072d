#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "effects/laws/laws.hpp"
#include "effects/temperature.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kAluminium = 23e-6;  // 1/K, growth of the lightest material of arms

Eigen::VectorXd approach(const Eigen::VectorXd& time, double constant) {
  return 1 - (-(time.array() - time[0]) / constant).exp();
}

/// °C at which a model's numbers hold, if it says so.
using Reference = std::optional<double>;

/// How far the structure has grown at every row of a scene.
using Growth = Eigen::VectorXd (*)(const Scene&, const Values&, Reference);

Eigen::VectorXd by_temperature(const Scene& scene, const Values& /*values*/, Reference reference) {
  return warming(scene, reference);
}

Eigen::VectorXd by_time(const Scene& scene, const Values& values, Reference /*reference*/) {
  return approach(scene.time, values.back());
}

/// Adds the change of a structure that has grown so far at every row.
using Drift = std::function<void(const Eigen::VectorXd& grown, const Values&, int joint,
                                 const Simulation&, Prediction*)>;

Law drift_law(const char* form, std::size_t amplitudes, Growth growth, Drift drift) {
  Law law;
  law.form = form;
  law.joints = whole_machine;
  law.traits.linear_in = amplitudes;
  law.traits.needs_temperature = growth == by_temperature;
  law.traits.is_gradual = growth == by_time;
  law.statement = says("the structure grows as it warms");
  law.apply = [growth, drift](const Values& values, int joint, Machine* machine) {
    const Reference reference = machine->robot.reference_temperature;
    machine->terms.push_back(
        {Term::output, [=](const Scene& scene, const Simulation& at, Prediction* prediction) {
           drift(growth(scene, values, reference), values, joint, at, prediction);
         }});
  };
  return law;
}

/// Amplitudes, and how fast they are reached where time stands in for the temperature.
std::vector<Parameter> parameters_of(const std::vector<std::string>& names, const char* unit,
                                     bool is_by_time) {
  std::vector<Parameter> all;
  all.reserve(names.size() + 1);
  for (const std::string& name : names) {
    all.push_back({name, is_by_time ? unit : std::string(unit) + "/K"});
  }
  if (is_by_time) {
    all.push_back({"time_constant", "s"});
  }
  return all;
}

/// Along directions of the base frame.
void drift_in_base(const Eigen::VectorXd& grown, const Values& values, int /*joint*/,
                   const Simulation& /*at*/, Prediction* prediction) {
  Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
  if (position.cols() > 0) {
    position += grown * Eigen::RowVector3d(values[0], values[1], values[2]);
  }
}

/// Along directions of a frame, which `turned` gives of the arm as it stands.
template <typename Rotation>
void drift_along_frame(const Eigen::VectorXd& grown, const Values& values, const Simulation& at,
                       const Rotation& turned, Prediction* prediction) {
  Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
  for (Eigen::Index row = 0; row < position.rows(); ++row) {
    const Vector3<double> direction = turned(at.bent[static_cast<std::size_t>(row)]) *
                                      Vector3<double>(values[0], values[1], values[2]);
    position.row(row) += grown[row] * direction.transpose();
  }
}

void drift_along_tool(const Eigen::VectorXd& grown, const Values& values, int /*joint*/,
                      const Simulation& at, Prediction* prediction) {
  const auto turned = [](const model::ChainKinematics& arm) { return arm.tcp.rotation; };
  drift_along_frame(grown, values, at, turned, prediction);
}

/// Along directions of the frame of the link that a joint moves.
void drift_along_link(const Eigen::VectorXd& grown, const Values& values, int joint,
                      const Simulation& at, Prediction* prediction) {
  const auto turned = [joint](const model::ChainKinematics& arm) {
    return arm.links[index_of(joint)].rotation;
  };
  drift_along_frame(grown, values, at, turned, prediction);
}

/// By a share of the way from the base to the last link: all that is between has grown alike.
void drift_of_arm(const Eigen::VectorXd& grown, const Values& values, int /*joint*/,
                  const Simulation& at, Prediction* prediction) {
  Eigen::MatrixXd& position = prediction->channel[simulation::tcp_position];
  for (Eigen::Index row = 0; row < position.rows(); ++row) {
    const auto& links = at.bent[static_cast<std::size_t>(row)].links;
    position.row(row) += values[0] * grown[row] * links.back().position.transpose();
  }
}

void drift_of_zero(const Eigen::VectorXd& grown, const Values& values, int joint,
                   const Simulation& at, Prediction* prediction) {
  add_joint_angle(at, joint, values[0] * grown, prediction);
}

Law base_law(const char* form, Growth growth) {
  Law law = drift_law(form, 3, growth, drift_in_base);
  law.parameters = constant(parameters_of({"x", "y", "z"}, "m", growth == by_time));
  return law;
}

Law tool_law(const char* form, Growth growth) {
  Law law = drift_law(form, 3, growth, drift_along_tool);
  law.parameters = constant(parameters_of({"tool_x", "tool_y", "tool_z"}, "m", growth == by_time));
  return law;
}

Law link_law(const char* form, Growth growth) {
  Law law = drift_law(form, 3, growth, drift_along_link);
  law.joints = all_but_the_last;  // the last one's grows like a tool
  law.parameters = constant(parameters_of({"x", "y", "z"}, "m", growth == by_time));
  law.statement = says("the link that joint {} moves grows as it warms");
  return law;
}

Law arm_law(const char* form, Growth growth) {
  Law law = drift_law(form, 1, growth, drift_of_arm);
  law.parameters = constant(parameters_of({"growth"}, "1", growth == by_time));
  law.statement = says("all links grow alike as they warm");
  return law;
}

Law zero_law(const char* form, Growth growth) {
  Law law = drift_law(form, 1, growth, drift_of_zero);
  law.joints = every_joint;
  law.parameters = of_joint(parameters_of({"zero"}, "rad", growth == by_time));
  law.statement = says("the zero of joint {} drifts as it warms");
  return law;
}

}  // namespace

// The structure grows as it warms, in proportion to the rise of temperature beyond that at which
// the model's numbers hold (without it, beyond that at which a recording begins), or towards a
// limit with time where no temperature was recorded (ISO 230-3). The TCP moves in a fixed direction
// of the base frame, as where the column grows, of a link, or of the tool frame, as where the
// spindle does; all links grow by the same share; or a joint's zero creeps.
Forms laws::thermal_drift() {
  constexpr const char* kColumn =
      "aluminium grows by 23e-6 a kelvin; up and forward, and five times as warm as the sensor";
  constexpr const char* kWarmColumn =
      "aluminium grows by 23e-6 a kelvin; up and forward, by 50 K (ISO 230-3)";
  constexpr const char* kTool =
      "aluminium grows by 23e-6 a kelvin; no tool is longer than half of the arm's reach";
  constexpr const char* kLink =
      "aluminium grows by 23e-6 a kelvin; no link is longer than the arm's reach";
  constexpr const char* kArm =
      "aluminium grows by 23e-6 a kelvin, five times as warm as the sensor";
  constexpr const char* kZero =
      "what holds an encoder grows by no more than 23e-6 of its size a kelvin, one side alone";
  return {
      {base_law("temperature", by_temperature), base_law("time", by_time),
       tool_law("tool", by_temperature), tool_law("tool_time", by_time),
       link_law("link", by_temperature), link_law("link_time", by_time),
       arm_law("arm", by_temperature), arm_law("arm_time", by_time),
       zero_law("zero", by_temperature), zero_law("zero_time", by_time)},
      {},
      {{"temperature", " x y z ",
        [](const Subject& of) { return within(10 * kAluminium * of.size.reach); }, kColumn},
       {"time", " x y z ",
        [](const Subject& of) { return within(100 * kAluminium * of.size.reach); }, kWarmColumn},
       {"tool", " tool_x tool_y tool_z ",
        [](const Subject& of) { return within(5 * kAluminium * of.size.reach); }, kTool},
       {"tool_time", " tool_x tool_y tool_z ",
        [](const Subject& of) { return within(50 * kAluminium * of.size.reach); }, kTool},
       {"link", " x y z ", [](const Subject& of) { return within(5 * kAluminium * of.size.reach); },
        kLink},
       {"link_time", " x y z ",
        [](const Subject& of) { return within(50 * kAluminium * of.size.reach); }, kLink},
       {"arm", " growth ", [](const Subject&) { return within(5 * kAluminium); }, kArm},
       {"arm_time", " growth ", [](const Subject&) { return within(50 * kAluminium); }, kArm},
       {"zero", " zero ", [](const Subject&) { return within(10 * kAluminium); }, kZero},
       {"zero_time", " zero ", [](const Subject&) { return within(100 * kAluminium); }, kZero},
       {"", " time_constant ",
        [](const Subject&) {
          return Range{10, std::numeric_limits<double>::infinity(), Rest::above};
        },
        "heat takes 8 s through 10 mm of steel (L²/α, α = 12e-6 m²/s); castings warm within hours "
        "(ISO 230-3), slowly like a straight line"}}};
}

}  // namespace flexcomp::effects
