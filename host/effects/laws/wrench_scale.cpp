#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Law scale_law(const char* form, std::vector<Parameter> parameters, SensorModel truth) {
  Law law;
  law.form = form;
  law.joints = whole_machine;
  law.traits.linear_in = parameters.size();
  law.traits.is_curved = true;
  law.parameters = constant(std::move(parameters));
  law.words = "gain of the force sensor";
  law.statement = says("the force sensor has another gain");
  alter_sensor(std::move(truth), &law);
  return law;
}

std::vector<Derived> whole_gain(const model::Robot& /*robot*/, int /*joint*/,
                                const Values& values) {
  return {{"gain", "1", 1 + values[0], 0}};
}

Wrench<double> all_alike(const Values& values, const Wrench<double>& read) {
  return read / (1 + values[0]);
}

/// Moments are measured right.
Wrench<double> forces_alike(const Values& values, const Wrench<double>& read) {
  Wrench<double> truth = read;
  truth.head<3>() /= 1 + values[0];
  return truth;
}

Wrench<double> each_force(const Values& values, const Wrench<double>& read) {
  Wrench<double> truth = read;
  for (int axis = 0; axis < 3; ++axis) {
    truth[axis] /= 1 + values[static_cast<std::size_t>(axis)];
  }
  return truth;
}

}  // namespace

// Gain of the force sensor: it reads gain times the wrench, gain times its forces, or each force
// times a gain of its own (ISO 376 calibrates a force at a time).
Forms laws::wrench_scale() {
  Law whole = scale_law("", {{"gain_error", "1"}}, all_alike);
  whole.derived = whole_gain;
  Law forces = scale_law("forces", {{"gain_error", "1"}}, forces_alike);
  forces.derived = whole_gain;
  const Law axes =
      scale_law("axes", {{"x_error", "1"}, {"y_error", "1"}, {"z_error", "1"}}, each_force);
  const auto range = [](const char* form, const char* names) {
    return ParameterRange{form, names,
                          [](const Subject&) {
                            return Range{-0.95, 10};
                          },
                          "the farthest unit of force is the kilogram-force, 9.81 N"};
  };
  return {{whole, forces, axes},
          {},
          {range("", " gain_error "), range("forces", " gain_error "),
           range("axes", " x_error y_error z_error ")}};
}

}  // namespace flexcomp::effects
