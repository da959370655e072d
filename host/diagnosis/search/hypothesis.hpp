#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/observations.hpp"
#include "diagnosis/spells.hpp"
#include "effects/law.hpp"

namespace flexcomp::diagnosis {

using effects::Values;

struct Hypothesis;

/// Starts for a hypothesis, sought in what is unexplained (all samples, over the noise); none where
/// it shows nothing of it.
using Seek = std::vector<Values> (*)(const Observations&, const Eigen::VectorXd& unexplained,
                                     const Hypothesis&);

/// Where a parameter is sought.
struct Bounds {
  double lower;
  double upper;
  double step;  ///< a size that matters: of finite differences, and of the fit's scale
};

/// One number of a hypothesis.
struct Parameter {
  std::string name;
  std::string unit;
  double lower;
  double upper;
  double step;  ///< as in Bounds
  /// Standard deviation about zero that a fit holds it to; endless where only the samples decide.
  double tolerance = std::numeric_limits<double>::infinity();
  /// Times as uncertain as among what is fitted: numbers that were left out could do the same.
  double widening = 1;
  bool is_of_recording = false;  ///< no number of the machine (effects/law.hpp)
  /// Another in every recording, as a tone's phase: what is held out is predicted by one of its
  /// own.
  bool is_of_each = false;
};

/// A law at one place, and where to begin with it in these observations.
struct Hypothesis {
  /// All parameters in proportion begin at zero; bounds are to be set.
  Hypothesis(effects::LawPointer law_there, int at_joint, const model::Robot& robot);

  effects::LawPointer law;
  int joint = 0;  ///< from 1 on, 0 where the law acts on the whole machine
  std::vector<Parameter> parameters;
  std::size_t linear = 0;  ///< of the parameters, the first so many act (nearly) in proportion
  /// Where to begin with the other parameters; with `linear` zero each start is a whole guess.
  std::vector<Values> starts = {{}};
  Seek seek = nullptr;  ///< where the starts are sought in what is unexplained
  /// Excess of a body (effects/law.hpp) that a fit holds it within, as by one sample more; endless
  /// where only the samples decide.
  double edge = std::numeric_limits<double>::infinity();
  /// The numbers are those of a regression, whatever body they would be of
  /// (families/regression.hpp).
  bool is_regression = false;
  bool is_sketched = false;  ///< the law's sketch is near enough for a first look
  /// When it acts, if it comes and goes; null where it always does.
  std::shared_ptr<const Spells> when;

  const std::string& effect() const { return law->effect; }
  const effects::Traits& traits() const { return law->traits; }
  /// Was the law composed or written by a person, and is none of the catalogue?
  bool is_law() const { return law->written != nullptr; }
  void apply(const Values& values, Machine* machine) const { law->apply(values, joint, machine); }
  /// One plain clause: what the machine has that the model lacks.
  std::string statement() const { return law->statement(joint); }

  /// Its parameters that the samples decide, and no tolerance.
  std::size_t numbers() const;

  /// Sets where the parameters are sought, in their order.
  void set_bounds(const std::vector<Bounds>& bounds);
};

/// Are they the same effect at the same place and the same times, in whatever form, or the same
/// formula there?
bool are_the_same(const Hypothesis& a, const Hypothesis& b);

/// All hypotheses of all effects that could show in the observations, within what the machine can
/// be (plausible.hpp); some may have no start.
std::vector<Hypothesis> all_hypotheses(const Observations& observations);

/// The hypotheses that seek their starts, with starts from what is unexplained now. Hypotheses for
/// which none is found are left out.
std::vector<Hypothesis> sought_anew(const Observations& observations,
                                    const Eigen::VectorXd& unexplained,
                                    const std::vector<Hypothesis>& hypotheses);

}  // namespace flexcomp::diagnosis
