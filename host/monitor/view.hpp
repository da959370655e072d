#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "monitor/live_node.hpp"

namespace flexcomp::monitor {

/// A snapshot as some lines of text for a terminal of 80 columns: state, faults in words, a row a
/// joint, wrench, latency and what was lost.
std::string view(const Snapshot& snapshot);

/// The same as JSON: SI units, null for what is not known.
nlohmann::ordered_json to_json(const Snapshot& snapshot);

}  // namespace flexcomp::monitor
