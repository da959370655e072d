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
  std::string form;                   ///< of several that the effect takes; else empty
  std::vector<Parameter> parameters;  ///< all zero, the first `linear` of them: no effect
  std::size_t linear = 0;             ///< of the parameters, those that act (nearly) in proportion
  /// Where to begin with the other parameters; with `linear` zero each start is a whole guess.
  std::vector<Values> starts = {{}};
  bool is_sought = false;      ///< the starts were sought in what was unexplained
  bool alters_model = false;   ///< the scene must be simulated anew; else it only adds a term
  bool is_shape_only = false;  ///< a curve for want of the law: a law that fits as well is meant
  bool is_curved = false;      ///< far from proportion: derivatives must be taken where it stands
  std::function<void(const Values&, simulation::Machine*)> apply;
  /// A term that does nearly the same, where `apply` alters the model; may be left out.
  std::function<simulation::Term(const Values&)> sketch;
  std::string statement;  ///< one plain clause: what the machine has that the model lacks
};

/// Are they the same effect at the same place, in whatever form?
bool are_the_same(const Hypothesis& a, const Hypothesis& b);

/// An entry of the catalogue.
struct Effect {
  const char* name;  ///< of the contract's vocabulary
  /// What it offers for what was observed; none where it could not show.
  std::vector<Hypothesis> (*hypotheses)(const Observations&);
  std::vector<std::string> forms;  ///< that its hypotheses may have; none where it has but one
};

/// Every effect that is known; a new one is a file in effects/ and a line in registry.cpp.
const std::vector<Effect>& registry();

/// All hypotheses of all effects, within what the machine can be (plausible.hpp); some may have no
/// start for what was observed.
std::vector<Hypothesis> all_hypotheses(const Observations& observations);

}  // namespace flexcomp::diagnosis
