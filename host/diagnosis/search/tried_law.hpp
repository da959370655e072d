#pragma once

#include <filesystem>

#include "diagnosis/search/hypothesis.hpp"

namespace flexcomp::diagnosis {

/// A person's own suspicion: a law written as a formula (effects/formula_law.hpp), whose parameters
/// are sought within the ranges that its file gives.
///
/// The file is a YAML map with the keys of an effect `law` of robot.yaml, and `ranges`: for each
/// parameter its lower and upper bound. A parameter in proportion may be nothing: its range holds
/// 0. Throws InputError with file, line and key for a law that cannot be, or not of these
/// observations.
Hypothesis read_tried_law(const std::filesystem::path& file, const Observations& observations);

}  // namespace flexcomp::diagnosis
