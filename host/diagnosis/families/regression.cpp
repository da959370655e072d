#include "diagnosis/families/regression.hpp"

#include <limits>

#include "diagnosis/families/elimination.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kFarAway = 1e6;  // steps: no number gets there

/// The hypotheses with links' masses that nothing holds. A payload adds nothing to those of the
/// last link.
std::vector<Hypothesis> unheld(const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> all;
  for (Hypothesis hypothesis : hypotheses) {
    if (hypothesis.traits().is_gain || (hypothesis.traits().is_body && hypothesis.joint == 0)) {
      continue;
    }
    if (hypothesis.traits().is_body) {
      hypothesis.is_regression = true;
      for (Parameter& parameter : hypothesis.parameters) {
        parameter.lower = -kFarAway * parameter.step;
        parameter.upper = kFarAway * parameter.step;
      }
    }
    all.push_back(std::move(hypothesis));
  }
  return all;
}

}  // namespace

Fit fit_regression(const Observations& observations, const Fit& given,
                   const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary) {
  Elimination numbers(observations, given, unheld(hypotheses), dictionary);
  return fit(observations, numbers.best(), kSimulatedSteps, &dictionary);
}

}  // namespace flexcomp::diagnosis
