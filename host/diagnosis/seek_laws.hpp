#pragma once

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/select/propose.hpp"

namespace flexcomp::diagnosis {

/// Seeks laws that nobody listed where there is a mismatch: in the place of what was found, which
/// may stand for a law, and beside it. They replace the findings where they leave far less, of what
/// was held out too. Where a machine's numbers together account for more than any finding, laws
/// must account for all.
///
/// The diagnosis must have been judged (verdict.hpp), and is judged again where it changes.
void seek_laws(const Inquiry& inquiry, const Settings& settings, Diagnosis* diagnosis);

}  // namespace flexcomp::diagnosis
