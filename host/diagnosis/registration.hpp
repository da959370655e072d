#pragma once

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Registers the instrument that measured the TCP: where its frame, and the point that it follows
/// on the tool, are so far from the model's that nothing else can be told before they are known.
///
/// Coarse: the rigid motion that brings the predicted positions nearest to the measured ones
/// (Umeyama 1991), repeated with Huber's weights. Fine: frame and tool fitted by simulation.
/// Nothing is chosen where the positions lie within a small path, where the frame is near enough
/// for a linear search, or where it does not account for most of the mismatch.
///
/// Returns the frame and, where it is as far off, the point on the tool, fitted. The laws that
/// place them say so (effects::Registers).
Fit register_frame(const Observations& observations, const std::vector<Hypothesis>& hypotheses);

}  // namespace flexcomp::diagnosis
