#pragma once

#include <nlohmann/json.hpp>

#include "diagnosis/diagnosis.hpp"

namespace flexcomp::diagnosis {

/// diagnosis.json as the README describes it.
nlohmann::ordered_json to_json(const Observations& observations, const Diagnosis& diagnosis);

}  // namespace flexcomp::diagnosis
