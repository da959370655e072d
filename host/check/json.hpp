#pragma once

#include <nlohmann/json.hpp>

#include "check/check.hpp"

namespace flexcomp::check {

/// A list of maps: severity, about, name, what, fix.
nlohmann::ordered_json as_json(const Checks& checks);

}  // namespace flexcomp::check
