#pragma once

#include "diagnosis/select/judge.hpp"

namespace flexcomp::diagnosis {

/// Replaces findings that the evidence does not prefer to a plainer one: two by one, one by another
/// with fewer parameters, a curve by its law. Each step takes away a finding, a parameter or a
/// joint. Every finding has its alternatives then.
Selection simplify(const Inquiry& inquiry, const Sought& sought, Selection selection);

}  // namespace flexcomp::diagnosis
