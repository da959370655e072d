#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Gain of the force sensor: it reads gain times the wrench. Needs a wrench.
std::vector<Hypothesis> wrench_scale(const Observations& observations) {
  if (!observations.has_wrench()) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "wrench_scale";
  hypothesis.parameters = {{"gain_error", "1", -0.9, 5, 0.05}};
  hypothesis.linear = 1;
  hypothesis.is_curved = true;
  hypothesis.statement = "the force sensor has another gain";
  set_sensor([](const Values& values,
                const Wrench<double>& read) { return Wrench<double>(read / (1 + values[0])); },
             &hypothesis);
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
