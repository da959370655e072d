#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// The steps that made a recording usable, for the report.
struct Quality {
  std::string file;
  simulation::Preparation preparation;
};

/// A self-contained page: what was found in one sentence, the residual before and after along time
/// and path, where it is, the ranking of hypotheses, parameters, what cannot be told apart, and
/// what to record next. Throws InputError where gnuplot is missing.
std::string to_html(const Observations& observations, const Diagnosis& diagnosis,
                    const std::vector<Quality>& qualities);

}  // namespace flexcomp::diagnosis
