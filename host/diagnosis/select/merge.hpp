#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// Puts plainer findings in the place of what the evidence does not prefer to them: one for two,
/// one with fewer parameters, a law for its mere curve. Every finding has its alternatives then.
/// Each step takes away a finding, a parameter or a joint.
Selection simplify(const Inquiry& inquiry, const Sought& sought, Selection selection);

}  // namespace flexcomp::diagnosis
