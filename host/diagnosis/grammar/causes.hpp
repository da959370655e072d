#pragma once

#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/grammar/shape.hpp"

namespace flexcomp::diagnosis::grammar {

/// What usually causes such a law, to be put behind its clause: "usually a cable or hose"; empty
/// where nothing is usual.
std::string usual_cause(const Lead& lead, const Shape& shape);

/// What to record next to see what a law in time stands for, in one sentence; empty for laws of
/// what was recorded.
std::string next_recording(const Chosen& law);

}  // namespace flexcomp::diagnosis::grammar
