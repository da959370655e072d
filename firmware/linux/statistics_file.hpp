#pragma once

#include <string>

#include "linux/exchange.hpp"

namespace flexcomp {

/// The statistics as JSON text.
std::string statistics_json(const Snapshot& snapshot);

/// A few lines of them for a person.
std::string statistics_summary(const Snapshot& snapshot);

}  // namespace flexcomp
