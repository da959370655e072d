#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// Pictures (SVG) of the laws among the findings: over the signal that drives a law the mean of the
/// error at its place, before and after, with the law's own course through it; the samples that it
/// was fitted to and those that were held out apart. Where a second signal acts, the samples above
/// and below its median are drawn apart too. Empty without laws.
std::string law_pictures(const Observations& observations, const Diagnosis& diagnosis);

}  // namespace flexcomp::diagnosis
