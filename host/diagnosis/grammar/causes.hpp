#pragma once

#include "diagnosis/grammar/screen.hpp"
#include "diagnosis/grammar/shape.hpp"

namespace flexcomp::diagnosis::grammar {

/// The usual cause of such a law, to be put behind its clause: "usually a cable or hose". Empty
/// where none is usual.
std::string usual_cause(const Lead& lead, const Shape& shape);

/// One sentence on the recording that would show what a law in time stands for. Empty for laws that
/// follow a recorded signal.
std::string next_recording(const Chosen& law);

}  // namespace flexcomp::diagnosis::grammar
