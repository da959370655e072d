#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// One number of an effect.
struct Parameter {
  std::string name;
  std::string unit;
  double lower;
  double upper;
  double step;  ///< a size that matters: of finite differences, and of the fit's scale
};

using Values = std::vector<double>;

/// One hypothesis: an effect at one place, in one of the forms it takes.
struct Hypothesis {
  std::string effect;                 ///< of the contract's vocabulary
  int joint = 0;                      ///< 1 to 6, 0 where the effect has no joint
  std::vector<Parameter> parameters;  ///< all zero, the first `linear` of them: no effect
  std::size_t linear = 0;             ///< of the parameters, those that act (nearly) in proportion
  /// Where to begin with the other parameters; with `linear` zero each start is a whole guess.
  std::vector<Values> starts = {{}};
  bool alters_model = false;  ///< the scene must be simulated anew; else it only adds a term
  std::function<void(const Values&, simulation::Machine*)> apply;
  std::string statement;  ///< one plain clause: what the machine has that the model lacks
};

/// The hypotheses that an effect offers for what was observed; none where it could not show.
using Effect = std::vector<Hypothesis> (*)(const Observations&);

/// Every effect that is known; a new one is a file in effects/ and a line in registry.cpp.
const std::vector<Effect>& registry();

/// All hypotheses of all effects.
std::vector<Hypothesis> all_hypotheses(const Observations& observations);

}  // namespace flexcomp::diagnosis
