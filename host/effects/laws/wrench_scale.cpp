#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Gain of the force sensor: it reads gain times the wrench.
Forms laws::wrench_scale() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 1;
  law.traits.is_curved = true;
  law.parameters = constant({{"gain_error", "1"}});
  law.words = "gain of the force sensor";
  law.statement = says("the force sensor has another gain");
  law.derived = [](const model::Robot&, int, const Values& values) {
    return std::vector<Derived>{{"gain", "1", 1 + values[0], 0}};
  };
  alter_sensor([](const Values& values,
                  const Wrench<double>& read) { return Wrench<double>(read / (1 + values[0])); },
               &law);
  return {{law},
          {},
          {{"", " gain_error ",
            [](const Subject&) {
              return Range{-0.95, 10};
            },
            "the farthest unit of force is the kilogram-force, 9.81 N"}}};
}

}  // namespace flexcomp::effects
