#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

/// Range of torque over range of force of six-axis sensors, m: 0.09 to 0.19 of ATI's Delta, Theta
/// and Omega (data sheets).
constexpr double kLever = 0.2;

}  // namespace

// Zero of the force sensor, in the tool frame: it reads the wrench plus the bias.
Forms laws::wrench_bias() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 6;
  law.parameters = constant(
      {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}, {"mx", "N·m"}, {"my", "N·m"}, {"mz", "N·m"}});
  law.words = "zero of the force sensor";
  law.statement = says("the force sensor has another zero");
  alter_sensor(
      [](const Values& values, const Wrench<double>& read) {
        return Wrench<double>(read - Eigen::Map<const Wrench<double>>(values.data()));
      },
      &law);
  return {
      {law},
      {},
      {{"", " fx fy fz ", [](const Subject& of) { return within(2 * of.size.payload * kGravity); },
        "force sensors' data sheets: ranges of once to twice the weight that their robots carry"},
       {"", " mx my mz ",
        [](const Subject& of) {
          const auto& effort = of.size.effort;
          const auto last_three = effort.size() < 3 ? effort.begin() : effort.end() - 3;
          const double wrist = *std::max_element(last_three, effort.end());
          return within(std::min(wrist, kLever * 2 * of.size.payload * kGravity));
        },
        "force sensors' data sheets: ranges of at most the torques that their robots' wrists bear, "
        "and of at most their own forces at 0.2 m"}}};
}

}  // namespace flexcomp::effects
