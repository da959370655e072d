#pragma once

#include "diagnosis/diagnosis.hpp"

/// Errors of a diagnosis in numbers, for its page.
namespace flexcomp::diagnosis {

/// Errors held out (or, where nothing is, of what was fitted), with the model, with the findings,
/// and with what stands in for the rest: a row a channel. HTML.
std::string channel_table(const Observations& observations, const Diagnosis& diagnosis);

/// The same for each joint or axis, against its own noise. HTML.
std::string component_table(const Observations& observations, const Diagnosis& diagnosis,
                            Channel channel);

/// Held-out error of a channel if one choice of a fit were left out and the others kept, SI.
double rms_without(const Observations& observations, const Fit& fit, std::size_t index,
                   Channel channel);

}  // namespace flexcomp::diagnosis
