#pragma once

#include <string>

#include "check/check.hpp"
#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// The steps that made a recording usable, for the report.
struct Quality {
  std::string file;
  simulation::Preparation preparation;
};

/// How a page came to be, as it tells.
struct Origin {
  std::vector<Quality> qualities;  ///< of the recordings
  check::Checks checks;            ///< what was wrong or suspicious in the input
  std::string command;             ///< that was given
  std::string version;             ///< of the program
  std::string date;
};

/// A self-contained page: what is wrong with the input, what was found in one sentence, errors
/// before and after, in all and for each joint, measured and simulated courses, where the mismatch
/// is, the ranking of hypotheses, parameters, what cannot be told apart, and what to record next.
/// Throws InputError where gnuplot is missing.
std::string to_html(const Observations& observations, const Diagnosis& diagnosis,
                    const Origin& origin);

}  // namespace flexcomp::diagnosis
