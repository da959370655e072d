#pragma once

#include "node/node.hpp"

namespace flexcomp {

/// Limits that suit a heavy machining robot on a 4 ms cycle, for a user to start from. The model
/// hash is left zero; joint speeds are 1.5 rad/s.
NodeConfig default_node_config();

}  // namespace flexcomp
