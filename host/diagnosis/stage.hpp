#pragma once

#include <functional>
#include <string>

namespace flexcomp::diagnosis {

/// Told what a diagnosis does now, in words; how long it takes nobody knows beforehand.
using TellStage = std::function<void(const std::string& stage)>;

}  // namespace flexcomp::diagnosis
