#pragma once

#include "diagnosis/dictionary.hpp"
#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Steps of the fit of many numbers by simulation, from close by: all of them act nearly in
/// proportion, so that few steps do.
constexpr int kSimulatedSteps = 8;

/// The plain refit of identification: masses, first moments and inertias of all links as the
/// numbers of a regression, whatever bodies they would be of, with friction, rotors and
/// zeros (Khalil and Dombre 2002, ch. 12). Bodies that can be explain less than it where torques
/// are not what their sensors say. It predicts, and is no finding.
///
/// `given` stays; chosen are those numbers that predict best what they were not fitted to.
Fit fit_regression(const Observations& observations, const Fit& given,
                   const std::vector<Hypothesis>& hypotheses, const Dictionary& dictionary);

}  // namespace flexcomp::diagnosis
