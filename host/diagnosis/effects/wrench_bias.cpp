#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Zero of the force sensor, in the tool frame: it reads the wrench plus the bias. Needs a wrench,
// and rotations of the tool or the TCP without load elsewhere.
std::vector<Hypothesis> wrench_bias(const Observations& observations) {
  if (!observations.has_wrench()) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "wrench_bias";
  constexpr const char* kNames[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  for (std::size_t i = 0; i < 6; ++i) {
    hypothesis.parameters.push_back(
        {kNames[i], i < 3 ? "N" : "N·m", -1e5, 1e5, i < 3 ? 20.0 : 5.0});
  }
  hypothesis.linear = 6;
  hypothesis.statement = "the force sensor has another zero";
  set_sensor(
      [](const Values& values, const Wrench<double>& read) {
        return Wrench<double>(read - Eigen::Map<const Wrench<double>>(values.data()));
      },
      &hypothesis);
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
