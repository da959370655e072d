#pragma once

#include <nlohmann/json.hpp>

#include "check/check.hpp"
#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// diagnosis.json as the README describes it, with what was wrong in the input.
nlohmann::ordered_json to_json(const Observations& observations, const Diagnosis& diagnosis,
                               const check::Checks& checks = {});

}  // namespace flexcomp::diagnosis
