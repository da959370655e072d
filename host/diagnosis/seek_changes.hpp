#pragma once

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// Seeks an effect that comes and goes while the machine is recorded, beside those that always act:
/// a part that is carried on some moves, a clamp that slips once and stays. Only for what all else
/// leaves unexplained, and taken only if no more than noise is left then: with moments of its own
/// choice an effect imitates much.
void seek_changes(const Inquiry& inquiry, const TellStage& tell, Diagnosis* diagnosis);

}  // namespace flexcomp::diagnosis
