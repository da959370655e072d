#pragma once

#include "diagnosis/select/choose.hpp"

namespace flexcomp::diagnosis {

/// Tries the other forms of each finding's law that have the same parameters. A form that fits
/// better, and predicts what was held out better, takes the place of the one that was found first.
///
/// No form is exactly the machine's. An interval is therefore made as wide as the forms that fit
/// nearly as well, or predict better, lie apart.
void settle_forms(const Inquiry& inquiry, Choice* choice);

}  // namespace flexcomp::diagnosis
